import { cell, element, setText } from "./dom";
import type { Channel, Process, Service, Status } from "./status";

const ORDER = ["log_replay", "frame_builder", "map_server", "window_optimizer"];
const SILENT_S = 3; // services send STATUS once a second

type Kind = "good" | "wait" | "bad" | "idle";
const SIGNS: Record<Kind, string> = { good: "●", wait: "◐", bad: "✖", idle: "○" };
const KINDS: Record<string, Kind> = { running: "good", finished: "idle", drained: "idle", failed: "bad", degraded: "bad" };

export const isSilent = (service: Service): boolean => service.age_s > SILENT_S;

function stateOf(service: Service | undefined, process: Process | undefined): { text: string; kind: Kind } {
  if (process?.restarting) return { text: "restarting", kind: "wait" };
  if (process && process.pid === 0) return { text: "not running", kind: "bad" };
  if (!service) return { text: "not heard", kind: "idle" };
  if (isSilent(service) && service.state !== "finished") return { text: `silent, ${Math.round(service.age_s)} s`, kind: "bad" };
  return { text: service.state, kind: KINDS[service.state] ?? "wait" };
}

// Which service does not run although it should, and what happens next; empty: none.
export function downReason(status: Status): string {
  const processes = status.processes ?? [];
  for (const service of status.services) {
    const process = processes.find(({ name }) => name === service.name);
    const { kind } = stateOf(service, process);
    if (kind !== "bad" || service.state === "failed" || service.state === "degraded") continue;
    const silence = `${service.name} has not been heard for ${Math.round(service.age_s)} s`;
    return process ? `${silence}; its supervisor starts it again` : `${silence}; start it again`;
  }
  return "";
}

// "/a/long/path/file: running" -> "file: running"
function withoutFolders(detail: string): string {
  return detail.replace(/(^|\s)\/(?:[^\s:/]+\/)+/g, "$1");
}

const THINGS: Record<string, string> = { KEYFRAME: "keyframe", EVENTS: "event packet", IMU: "IMU batch", MAP_POINTS: "map answer", TRACKER_MODE: "tracker answer" };
const FATES: Record<string, string> = {
  lost: "lost on the way",
  dropped: "left out for lack of time",
  invalid: "not valid",
  overrun: "overrun",
};
const several = (n: number, thing: string) => `${n.toLocaleString("en")} ${n === 1 ? thing : thing.endsWith("ch") ? `${thing}es` : `${thing}s`}`;

// What did not reach it or was not used, in words.
export function lossesOf(service: Service): string {
  const parts = Object.entries(service.counters).flatMap(([name, value]) => {
    if (value === 0) return [];
    if (name === "bus.queue_drops") return [`${several(value, "message")} too many at once`];
    const [, thing, fate] = /^(.+)\.(lost|invalid|dropped|overrun)$/.exec(name) ?? [];
    if (!thing || thing === "mode") return [];
    return [`${several(value, THINGS[thing] ?? `${thing} message`)} ${FATES[fate!]}`];
  });
  return parts.join(", ");
}

// What waits in the service now.
function queueOf(service: Service | undefined): string {
  const waiting = Object.entries(service?.counters ?? {}).filter(([name]) => name.endsWith(".queued"));
  return waiting.length ? String(waiting.reduce((sum, [, value]) => sum + value, 0)) : "";
}

// Health of the services, what waits in them and what they lost, and the channels.
export class ServicesView {
  constructor(private readonly restart: (name: string) => void) {}

  show(status: Status): void {
    const processes = status.processes ?? [];
    const heard = new Set([...status.services.map((s) => s.name), ...processes.map((p) => p.name)]);
    const names = new Set([...ORDER, ...heard]);
    if (heard.size > 0 && !heard.has("log_replay")) names.delete("log_replay"); // a robot has none
    const table = element<HTMLTableElement>("services");
    const head = document.createElement("tr");
    head.innerHTML = "<th>service<th>state<th class=number>CPU, %<th class=number>MB<th class=number title='Messages that wait in it now'>queue<th>";
    const rows = [...names].map((name) => {
      const service = status.services.find((s) => s.name === name);
      const process = processes.find((p) => p.name === name);
      return this.row(name, service, process, status.read_only);
    });
    // A button under the pointer stays where it is: the table is replaced only while none is pressed.
    if (!table.matches(":active")) table.replaceChildren(head, ...rows.flat());
    this.showChannels(status.channels ?? []);
  }

  private row(name: string, service: Service | undefined, process: Process | undefined, readOnly: boolean) {
    const row = document.createElement("tr");
    row.className = "service";
    row.dataset.service = name;
    row.dataset.pid = String(process?.pid ?? 0);
    const { text, kind } = stateOf(service, process);
    const state = cell(`${SIGNS[kind]} ${text}`, "state");
    state.dataset.kind = kind;
    const runs = process !== undefined && process.pid !== 0;
    const action = document.createElement("td");
    action.className = "number";
    if (process && !readOnly) {
      const button = document.createElement("button");
      button.textContent = "↻";
      button.title = `Restart ${name}`;
      button.setAttribute("aria-label", button.title);
      button.disabled = process.restarting;
      button.onclick = () => this.restart(name);
      action.append(button);
    }
    row.append(
      cell(name, "name"),
      state,
      cell(runs ? (100 * process.cpu).toFixed(0) : "", "number"),
      cell(runs ? process.memory_mb.toFixed(0) : "", "number"),
      cell(queueOf(service), "number"),
      action,
    );
    return [row, this.detail(service)];
  }

  private detail(service: Service | undefined): HTMLTableRowElement {
    const row = document.createElement("tr");
    const detail = cell("", "detail");
    detail.colSpan = 6;
    row.append(detail);
    if (!service) return row;
    const losses = lossesOf(service);
    if (losses) {
      const loss = document.createElement("em");
      loss.textContent = losses;
      detail.append(loss);
    }
    detail.append(withoutFolders(service.detail));
    detail.title = [
      service.detail,
      ...Object.entries({ ...service.timings_ms, ...service.counters }).map(
        ([key, value]) => `${key} ${Number.isInteger(value) ? value : value.toFixed(2)}`,
      ),
    ].join("\n");
    return row;
  }

  private showChannels(channels: Channel[]): void {
    const head = document.createElement("tr");
    head.innerHTML = "<th>channel<th class=number>per s<th class=number>lost<th class=number>invalid";
    const rows = channels.map((channel) => {
      const row = document.createElement("tr");
      const count = (n: number) => cell(n.toLocaleString("en"), n > 0 ? "number some" : "number");
      row.append(cell(channel.name), cell(channel.rate_hz.toFixed(0), "number"), count(channel.lost), count(channel.invalid));
      return row;
    });
    element("channels").replaceChildren(head, ...rows);
    const sum = (of: (channel: Channel) => number) => channels.reduce((total, channel) => total + of(channel), 0);
    const bad = sum((c) => c.lost + c.invalid);
    const rate = `${sum((c) => c.rate_hz).toFixed(0)} messages/s as this monitor hears them`;
    setText("channels-summary", channels.length ? `${rate}, ${bad ? `${bad.toLocaleString("en")} lost or invalid` : "none lost"}` : "none heard");
  }
}
