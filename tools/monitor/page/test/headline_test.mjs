// What the page's first line says in every state of a pipeline: node headline_test.mjs
import assert from "node:assert/strict";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const folder = join(dirname(fileURLToPath(import.meta.url)), "../src");
const contents = 'export { headline } from "./headline"; export { lossesOf } from "./services_view";';
const bundle = await build({ stdin: { contents, resolveDir: folder, loader: "ts" }, bundle: true, format: "esm", write: false });
const { headline, lossesOf } = await import(`data:text/javascript;base64,${Buffer.from(bundle.outputFiles[0].contents).toString("base64")}`);

const service = (name, state, more = {}) => ({ name, state, detail: `${state} as it should`, progress: -1, age_s: 0.3, counters: {}, timings_ms: {}, ...more });
const robot = (...changed) =>
  ["frame_builder", "map_server", "window_optimizer"].map((name) => changed.find((other) => other.name === name) ?? service(name, "running"));
const channels = (tracker, keyframes) => [{ name: "TRACKER_MODE", rate_hz: tracker }, { name: "KEYFRAME", rate_hz: keyframes }];
const status = (services, more = {}) => ({ type: "status", read_only: false, viewers: 1, waiting: "", services, channels: channels(50, 50), ...more });
const mode = (name, reason) => ({ type: "mode", mode: name, reason });
const window = { points: 1970, inlierShare: 0.09 };
const replay = (state, detail) => service("log_replay", state, { detail });
const expect = (heard, kind, name, reason) => {
  const got = headline({ online: true, status: status(robot()), mode: mode("tracking", "tracking"), window, near: 0.31, ...heard });
  assert.deepEqual([got.kind, got.name], [kind, name], got.reason);
  assert.match(got.reason, reason);
};

expect({ online: false }, "bad", "no monitor", /does not answer.*`evit monitor`/);
expect({ status: null }, "idle", "connecting", /monitor/);
expect({ status: status([], { waiting: "waiting for `evit run`" }) }, "idle", "no pipeline", /evit run/);
expect({ status: status([]) }, "idle", "no service", /none has been heard/);
expect({}, "good", "tracking", /^from 1,970 map points in view, 31 % of them near events$/);
expect({ near: null }, "good", "tracking", /^from 1,970 map points in view$/);
const slow = service("window_optimizer", "running", { counters: { "overload.level": 2 } });
expect({ status: status(robot(slow)) }, "good", "tracking", /too slow, overload level 2$/);
expect({ mode: mode("tracking", "coasting: no events") }, "good", "tracking", /^coasting: no events$/);
expect({ mode: mode("lost", "coasted too long") }, "bad", "lost", /coasted too long/);
expect({ mode: mode("bootstrapping", "localising high-rate frames") }, "wait", "starting", /localising/);
expect({ mode: null }, "wait", "starting", /window_optimizer: running as it should/);
expect({ mode: null, status: status([service("map_server", "running")]) }, "wait", "starting", /waiting for window_optimizer/);
expect({ status: status(robot(), { channels: channels(0, 0) }) }, "wait", "no data", /no keyframe comes: frame_builder: running/);
expect({ status: status(robot(service("map_server", "failed", { detail: "no such file" }))) }, "bad", "failed", /map_server: no such file/);
const silent = service("map_server", "running", { age_s: 7.2 });
expect({ status: status(robot(silent)) }, "bad", "service down", /map_server has not been heard for 7 s; start it again/);
const dead = { processes: [{ name: "map_server", pid: 0, restarting: false }] };
expect({ status: status(robot(silent), dead) }, "bad", "service down", /its supervisor starts it again/);
expect({ status: status(robot().map((one) => ({ ...one, age_s: 9 }))) }, "idle", "over", /has ended/);
expect({ status: status([...robot(), service("log_replay", "paused", { detail: "a.lcmlog: 1.50 of 3.00 s", progress: 0.5 })]) }, "wait", "paused", /^at 1\.50 of 3\.00 s; Play continues\. It was tracking then\.$/);
expect({ status: status([...robot(), replay("finished", "a.lcmlog: 3.00 of 3.00 s, all sent")]) }, "idle", "ended", /^the recording is over, 3\.00 of 3\.00 s; Play shows it again\. It was tracking at the end\.$/);
const begin = service("log_replay", "paused", { detail: "a.lcmlog: 0.00 of 3.00 s", progress: 0 });
expect({ mode: null, status: status([...robot(), begin]) }, "wait", "paused", /^all is ready, the recording waits at its begin \(0\.00 of 3\.00 s\): press Play$/);
// evit run has stopped its services: nothing plays again, and log_replay names no place.
const stopped = ["frame_builder", "window_optimizer"].map((name) => service(name, "finished", { detail: "stopped" }));
expect({ status: status([...stopped, replay("finished", "a.lcmlog: stopped")]) }, "idle", "over", /^the run has ended; .* It was tracking at the end\. /);
expect({ status: status([...robot(), replay("waiting", "waiting for credit")]) }, "wait", "waiting", /log_replay: waiting for credit/);

const losses = (counters) => lossesOf(service("window_optimizer", "running", { counters }));
assert.equal(losses({ "KEYFRAME.dropped": 1452, "KEYFRAME.invalid": 1, "IMU.lost": 0, "mode.lost": 3 }), "1,452 keyframes left out for lack of time, 1 keyframe not valid");
assert.equal(losses({ "STREAM_END.lost": 2 }), "2 STREAM_END messages lost on the way");
console.log("all states have their line");
