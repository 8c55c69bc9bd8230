import type { WindowState } from "./frames";
import { downReason, isSilent } from "./services_view";
import type { Mode, Service, Status } from "./status";

export type Kind = "good" | "wait" | "bad" | "idle";

export interface Headline {
  kind: Kind;
  name: string; // what the whole is doing, a word or two
  reason: string; // why, and what to do about it
}

export const SIGNS: Record<Kind, string> = { good: "✓", wait: "…", bad: "✗", idle: "○" };

export interface Heard {
  online: boolean;
  status: Status | null;
  mode: Mode | null;
  window: WindowState | null;
  near?: number | null; // share of the map's points that have events near them; null: no picture
}

const SETTLED = /^(tracking|bootstrapped)$/; // reasons that say no more than the mode does

// The place in the recording, "11.41 of 12.00 s"; empty: not told.
export function placeOf(replay: Service | undefined): string {
  return /[\d.]+ of [\d.]+ s/.exec(replay?.detail ?? "")?.[0] ?? "";
}

// Those that make poses have stopped: nobody plays anything again.
export function isOver({ services }: Status): boolean {
  const makers = services.filter(({ name }) => name === "window_optimizer" || name === "frame_builder");
  return makers.length > 0 && makers.every((s) => s.state === "finished" || (isSilent(s) && s.state === "drained"));
}

// What the estimate rests on.
function basis(window: WindowState, near: number | null): string {
  const points = `from ${window.points.toLocaleString("en")} map points in view`;
  return near === null ? points : `${points}, ${Math.round(100 * near)} % of them near events`;
}

function pausedReason(replay: Service, mode: Mode | null): string {
  const place = placeOf(replay);
  if (replay.progress <= 0) return `all is ready, the recording waits at its begin (${place}): press Play`;
  return `at ${place}; Play continues.${mode ? ` It was ${mode.mode} then.` : ""}`;
}

function tracking(heard: Heard, status: Status, mode: Mode): Headline {
  const rateOf = (channel: string) => status.channels?.find(({ name }) => name.endsWith(channel))?.rate_hz ?? 0;
  if (rateOf("TRACKER_MODE") === 0) {
    const builder = status.services.find(({ name }) => name === "frame_builder");
    const why = rateOf("KEYFRAME") === 0 ? `no keyframe comes: frame_builder: ${builder?.detail ?? "not heard"}` : "the tracker is silent";
    return { kind: "wait", name: "no data", reason: why };
  }
  if (mode.mode === "lost") return { kind: "bad", name: "lost", reason: mode.reason };
  if (mode.mode === "bootstrapping") return { kind: "wait", name: "starting", reason: mode.reason };
  const level = status.services.find(({ name }) => name === "window_optimizer")?.counters["overload.level"] ?? 0;
  const settled = SETTLED.test(mode.reason) && heard.window;
  const reason = settled ? basis(heard.window!, heard.near ?? null) : mode.reason;
  return { kind: "good", name: "tracking", reason: level > 0 ? `${reason}; this host is too slow, overload level ${level}` : reason };
}

// What the pipeline is doing, in one word and a sentence: the first of these that holds.
export function headline(heard: Heard): Headline {
  const { online, status, mode } = heard;
  if (!online) return { kind: "bad", name: "no monitor", reason: "the monitor does not answer; trying again. `evit monitor` starts it" };
  if (!status) return { kind: "idle", name: "connecting", reason: "to the monitor …" };
  if (status.waiting) return { kind: "idle", name: "no pipeline", reason: status.waiting };
  const { services } = status;
  const processes = status.processes ?? [];
  if (services.length === 0 && processes.length === 0) return { kind: "idle", name: "no service", reason: "waiting for services: none has been heard on the bus" };
  const ended = services.length > 0 && services.every((s) => s.state === "finished" || s.state === "drained" || isSilent(s));
  if (processes.length === 0 && ended && services.some(isSilent)) {
    return { kind: "idle", name: "over", reason: "the pipeline has ended; this is the last that was heard of it" };
  }
  const was = mode ? ` It was ${mode.mode} at the end.` : "";
  if (isOver(status)) return { kind: "idle", name: "over", reason: `the run has ended; this is the last that was heard of it.${was} Start it again to see it again` };
  const down = downReason(status);
  if (down) return { kind: "bad", name: "service down", reason: down };
  const failed = services.find(({ state }) => state === "failed");
  if (failed) return { kind: "bad", name: "failed", reason: `${failed.name}: ${failed.detail}` };
  const replay = services.find(({ name }) => name === "log_replay");
  if (replay?.state === "paused") return { kind: "wait", name: "paused", reason: pausedReason(replay, mode) };
  if (replay && (replay.state === "finished" || replay.progress >= 1)) {
    return { kind: "idle", name: "ended", reason: `the recording is over${placeOf(replay) && `, ${placeOf(replay)}`}; Play shows it again.${was}` };
  }
  if (replay && (replay.state === "waiting" || replay.state === "starting")) return { kind: "wait", name: "waiting", reason: `log_replay: ${replay.detail}` };
  if (mode) return tracking(heard, status, mode);
  const optimizer = services.find(({ name }) => name === "window_optimizer");
  return { kind: "wait", name: "starting", reason: optimizer ? `window_optimizer: ${optimizer.detail}` : "waiting for window_optimizer, which has not been heard" };
}
