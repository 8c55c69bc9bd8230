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
}

const SETTLED = /^(tracking|bootstrapped)$/; // reasons that say no more than the mode does

// The place in the recording, "11.41 of 12.00 s"; empty: not told.
export function placeOf(replay: Service | undefined): string {
  return /[\d.]+ of [\d.]+ s/.exec(replay?.detail ?? "")?.[0] ?? "";
}

// What the estimate rests on.
function basis(window: WindowState): string {
  return `from ${window.points.toLocaleString("en")} map points in view, ${Math.round(100 * window.inlierShare)} % of them on edges`;
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
  const reason = settled ? basis(heard.window!) : mode.reason;
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
  const down = downReason(status);
  if (down) return { kind: "bad", name: "service down", reason: down };
  const failed = services.find(({ state }) => state === "failed");
  if (failed) return { kind: "bad", name: "failed", reason: `${failed.name}: ${failed.detail}` };
  const replay = services.find(({ name }) => name === "log_replay");
  const when = mode ? ` It was ${mode.mode} then.` : "";
  if (replay?.state === "paused") return { kind: "wait", name: "paused", reason: `at ${placeOf(replay)}; Play continues.${when}` };
  if (replay && (replay.state === "finished" || replay.progress >= 1)) {
    return { kind: "idle", name: "ended", reason: `the recording is over, ${placeOf(replay)}; Play shows it again.${when}` };
  }
  if (replay && (replay.state === "waiting" || replay.state === "starting")) return { kind: "wait", name: "waiting", reason: `log_replay: ${replay.detail}` };
  if (mode) return tracking(heard, status, mode);
  const optimizer = services.find(({ name }) => name === "window_optimizer");
  return { kind: "wait", name: "starting", reason: optimizer ? `window_optimizer: ${optimizer.detail}` : "waiting for window_optimizer, which has not been heard" };
}
