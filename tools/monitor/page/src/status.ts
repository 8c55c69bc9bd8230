// Text messages of the server: the counterpart of tools/monitor/status_text.h.

export interface Service {
  name: string;
  state: string;
  detail: string;
  progress: number;
  age_s: number;
  counters: Record<string, number>;
  timings_ms: Record<string, number>;
}

export interface Process {
  deputy: string;
  name: string;
  pid: number;
  cpu: number;
  memory_mb: number;
  restarting: boolean;
}

export interface Channel {
  name: string;
  rate_hz: number;
  received: number;
  lost: number;
  invalid: number;
  restarts: number;
}

export interface CameraInfo {
  width: number;
  height: number;
  fx: number;
  fy: number;
  cx: number;
  cy: number;
  position?: [number, number, number]; // T_body_camera
  orientation?: [number, number, number, number];
}

export interface Status {
  type: "status";
  read_only: boolean;
  viewers: number;
  waiting: string;
  services: Service[];
  processes?: Process[];
  channels?: Channel[];
  camera?: CameraInfo | null;
  map?: { known: number; total: number };
}

export interface Mode {
  type: "mode";
  mode: "bootstrapping" | "tracking" | "lost";
  reason: string;
}

export interface Answer {
  type: "answer";
  ok: boolean;
  text: string;
}

export interface Places {
  type: "places";
  places: { position: number[]; orientation: number[]; significance: number }[];
}

export interface Drawn {
  type: "drawn";
  picture_ms: number; // from a picture's instant until it was on the screen
}

export type Text = Status | Mode | Answer | Places | Drawn;
