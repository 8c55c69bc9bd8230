import { cell, element, setText } from "./dom";
import type { Channel, Process, Service, Status } from "./status";

const ORDER = ["log_replay", "frame_builder", "map_server", "window_optimizer"];
const SILENT_S = 3; // services send STATUS once a second

type Kind = "good" | "wait" | "bad";
const SIGNS: Record<Kind, string> = { good: "●", wait: "◐", bad: "✖" };

function stateOf(service: Service | undefined, process: Process | undefined): { text: string; kind: Kind } {
  if (process?.restarting) return { text: "restarting", kind: "wait" };
  if (process && process.pid === 0) return { text: "not running", kind: "bad" };
  if (!service) return { text: "not heard", kind: "bad" };
  if (service.age_s > SILENT_S) return { text: `silent for ${Math.round(service.age_s)} s`, kind: "bad" };
  const kinds: Record<string, Kind> = { running: "good", finished: "good", drained: "good", failed: "bad", degraded: "bad" };
  return { text: service.state, kind: kinds[service.state] ?? "wait" };
}

// "/a/long/path/file: running" -> "file: running"
function withoutFolders(detail: string): string {
  return detail.replace(/(^|\s)\/(?:[^\s:/]+\/)+/g, "$1");
}

function queuesOf(service: Service): string {
  const interesting = Object.entries(service.counters).filter(
    ([name, value]) => value > 0 && /\.(lost|invalid|dropped|superseded|overrun|out_of_order|duplicate)$|^queue/.test(name),
  );
  return interesting.map(([name, value]) => `${name} ${value}`).join(", ");
}

// Health of the services, what they lost, and the channels.
export class ServicesView {
  constructor(private readonly restart: (name: string) => void) {}

  show(status: Status): void {
    const processes = status.processes ?? [];
    const names = new Set([...ORDER, ...status.services.map((s) => s.name), ...processes.map((p) => p.name)]);
    const heard = new Set([...status.services.map((s) => s.name), ...processes.map((p) => p.name)]);
    if (heard.size > 0 && !heard.has("log_replay")) names.delete("log_replay"); // a robot has none
    const table = element<HTMLTableElement>("services");
    const rows = [...names].map((name) => {
      const service = status.services.find((s) => s.name === name);
      const process = processes.find((p) => p.name === name);
      return this.row(name, service, process, status.read_only);
    });
    table.replaceChildren(...rows.flat());
    this.showChannels(status.channels ?? []);
    const level = status.services.find((s) => s.name === "window_optimizer")?.counters["overload.level"];
    setText("overload", level === undefined ? "–" : level === 0 ? "none" : `level ${level}`);
  }

  private row(name: string, service: Service | undefined, process: Process | undefined, readOnly: boolean) {
    const row = document.createElement("tr");
    row.dataset.service = name;
    row.dataset.pid = String(process?.pid ?? 0);
    const { text, kind } = stateOf(service, process);
    const state = cell(`${SIGNS[kind]} ${text}`, "state");
    state.dataset.kind = kind;
    const load = process && process.pid ? `${Math.round(100 * process.cpu)} % CPU, ${Math.round(process.memory_mb)} MB` : "";
    const lost = service ? queuesOf(service) : "";
    const detail = cell([service && withoutFolders(service.detail), load, lost].filter(Boolean).join(" · "), "detail");
    detail.title = service
      ? Object.entries({ ...service.timings_ms, ...service.counters })
          .map(([key, value]) => `${key} ${Number.isInteger(value) ? value : value.toFixed(2)}`)
          .join("\n")
      : "";
    const action = document.createElement("td");
    if (process && !readOnly) {
      const button = document.createElement("button");
      button.textContent = "Restart";
      button.disabled = process.restarting;
      button.onclick = () => this.restart(name);
      action.append(button);
    }
    const more = document.createElement("tr");
    detail.colSpan = 3;
    more.append(detail);
    row.append(cell(name, "name"), state, action);
    return [row, more];
  }

  private showChannels(channels: Channel[]): void {
    const head = document.createElement("tr");
    head.innerHTML = "<th>channel<th class=number>per s<th class=number>lost<th class=number>invalid";
    const rows = channels.map((channel) => {
      const row = document.createElement("tr");
      const count = (n: number) => cell(String(n), n > 0 ? "number some" : "number");
      row.append(cell(channel.name), cell(channel.rate_hz.toFixed(0), "number"), count(channel.lost), count(channel.invalid));
      return row;
    });
    element("channels").replaceChildren(head, ...rows);
  }
}
