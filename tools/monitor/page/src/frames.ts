// Binary frames of the server: the counterpart of tools/monitor/page_frames.h, which says what is where.

export const enum FrameKind {
  Pose = 1,
  Truth = 2,
  Window = 3,
  Picture = 4,
  Map = 5,
  History = 6,
}

export interface Pose {
  utime: number; // us, sensor clock
  position: [number, number, number]; // m, map frame
  orientation: [number, number, number, number]; // x y z w, body to map
  velocity: [number, number, number]; // m/s
}

export interface WindowState extends Pose {
  mode: number;
  gyroBias: [number, number, number]; // rad/s
  accelBias: [number, number, number]; // m/s^2
  covariance: Float32Array; // 6x6: position (m, map), rotation (rad, body)
  inlierShare: number;
  meanCost: number; // 0..255
  solveMs: number;
  totalMs: number;
  latencyMs: number; // negative: not known
  points: number;
  near?: number | null; // share of the points that had events near them; the page's own figure
}

export const TRACKING = 1; // a WindowState's mode, as in lcmtypes/tracker_mode_t.lcm

export interface Picture {
  utime: number;
  width: number;
  height: number;
  eventRate: number; // events/s; negative: not known
  decayUs: number;
  pixels: Int16Array; // 1/16 pixel, x y x y ...
  residuals: Uint8Array; // 0 on an edge .. 255
  surface: Uint8Array;
}

export interface MapPiece {
  generation: number;
  first: number;
  capacity: number; // as many points come at most
  xyz: Float32Array;
}

type Triple = [number, number, number];

const triple = (v: DataView, at: number): Triple => [
  v.getFloat32(at, true),
  v.getFloat32(at + 4, true),
  v.getFloat32(at + 8, true),
];

function readPose(v: DataView): Pose {
  return {
    utime: v.getFloat64(8, true),
    position: triple(v, 16),
    orientation: [...triple(v, 28), v.getFloat32(40, true)],
    velocity: triple(v, 44),
  };
}

function readWindow(v: DataView): WindowState {
  const figure = (i: number) => v.getFloat32(224 + 4 * i, true);
  return {
    ...readPose(v),
    mode: v.getUint32(4, true),
    gyroBias: triple(v, 56),
    accelBias: triple(v, 68),
    covariance: new Float32Array(v.buffer, v.byteOffset + 80, 36),
    inlierShare: figure(0),
    meanCost: figure(1),
    solveMs: figure(2),
    totalMs: figure(3),
    latencyMs: figure(4),
    points: figure(5),
  };
}

function readPicture(v: DataView): Picture {
  const width = v.getUint16(4, true);
  const height = v.getUint16(6, true);
  const n = v.getUint32(16, true);
  return {
    utime: v.getFloat64(8, true),
    width,
    height,
    eventRate: v.getFloat32(20, true),
    decayUs: v.getFloat32(24, true),
    pixels: new Int16Array(v.buffer, 32, 2 * n),
    residuals: new Uint8Array(v.buffer, 32 + 4 * n, n),
    surface: new Uint8Array(v.buffer, 32 + 5 * n, width * height),
  };
}

function readMap(v: DataView): MapPiece {
  return {
    generation: v.getUint32(4, true),
    first: v.getUint32(8, true),
    capacity: v.getUint32(16, true),
    xyz: new Float32Array(v.buffer, 20, 3 * v.getUint32(12, true)),
  };
}

// What happened before the page was opened, oldest first.
export interface History {
  windows: WindowState[];
  truths: Pose[];
}

const HEAD = 16; // bytes
const WINDOW = 248;
const POSE = 56;

function readHistory(v: DataView): History {
  const [windows, truths] = [v.getUint32(4, true), v.getUint32(8, true)];
  const part = (at: number, size: number) => new DataView(v.buffer, at, size);
  return {
    windows: Array.from({ length: windows }, (_, i) => readWindow(part(HEAD + WINDOW * i, WINDOW))),
    truths: Array.from({ length: truths }, (_, i) => readPose(part(HEAD + WINDOW * windows + POSE * i, POSE))),
  };
}

export interface FrameHandler {
  pose(pose: Pose): void;
  truth(pose: Pose): void;
  window(state: WindowState): void;
  picture(picture: Picture): void;
  map(piece: MapPiece): void;
  history(history: History): void;
}

export function readFrame(buffer: ArrayBuffer, to: FrameHandler): void {
  const view = new DataView(buffer);
  switch (view.getUint32(0, true)) {
    case FrameKind.Pose:
      return to.pose(readPose(view));
    case FrameKind.Truth:
      return to.truth(readPose(view));
    case FrameKind.Window:
      return to.window(readWindow(view));
    case FrameKind.Picture:
      return to.picture(readPicture(view));
    case FrameKind.Map:
      return to.map(readMap(view));
    case FrameKind.History:
      return to.history(readHistory(view));
    default: // of a newer server
  }
}
