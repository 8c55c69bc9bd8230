import { readFrame, type FrameHandler } from "./frames";
import type { Answer, Drawn, Mode, Places, Status, Text } from "./status";

export interface Handler extends FrameHandler {
  status(status: Status): void;
  mode(mode: Mode): void;
  answer(answer: Answer): void;
  places(places: Places): void;
  drawn(drawn: Drawn): void;
  connected(yes: boolean): void;
}

export type Order =
  | { order: "drawn"; utime: number }
  | { order: "restart"; command: string }
  | { order: "pause" | "resume" }
  | { order: "seek"; share: number }
  | { order: "speed"; speed: number }
  | { order: "hint"; position: number[]; orientation: number[] };

const RETRY_MS = 500;

// The line to the server; comes back by itself.
export class Connection {
  private socket: WebSocket | null = null;

  constructor(private readonly handler: Handler) {
    this.open();
  }

  send(order: Order): void {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(order));
  }

  private open(): void {
    const url = new URL("/", location.href);
    url.protocol = url.protocol === "https:" ? "wss:" : "ws:";
    const socket = new WebSocket(url, "evit-monitor.v1");
    socket.binaryType = "arraybuffer";
    socket.onopen = () => this.handler.connected(true);
    socket.onmessage = (event: MessageEvent<string | ArrayBuffer>) => this.receive(event.data);
    socket.onclose = () => {
      this.handler.connected(false);
      setTimeout(() => this.open(), RETRY_MS);
    };
    this.socket = socket;
  }

  private receive(data: string | ArrayBuffer): void {
    if (typeof data !== "string") return readFrame(data, this.handler);
    const text = JSON.parse(data) as Text;
    if (text.type === "status") this.handler.status(text);
    else if (text.type === "mode") this.handler.mode(text);
    else if (text.type === "places") this.handler.places(text);
    else if (text.type === "answer") this.handler.answer(text);
    else if (text.type === "drawn") this.handler.drawn(text);
  }
}
