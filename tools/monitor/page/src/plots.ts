import uPlot from "uplot";
import { color, element, onThemeChange, setText } from "./dom";
import { TRACKING, type WindowState } from "./frames";

const SPAN_S = 60;
const SHORTEST_S = 10; // shown, until there is more
const REDRAW_MS = 300;

interface Curve {
  label: string;
  color: string;
  dash?: number[];
  of: (state: WindowState) => number | null;
}

interface Plan {
  title: string;
  unit: string;
  digits: number; // of the newest value, beside the title
  curves: Curve[];
}

const sigma = (state: WindowState, first: number) =>
  Math.hypot(...[first, first + 1, first + 2].map((i) => Math.sqrt(Math.max(0, state.covariance[7 * i]!))));
// Okabe and Ito; dashes too, so that curves differ without colour.
const [BLUE, ORANGE, GREEN] = ["#2f8fd0", "#d98b00", "#12a07a"];

// Nobody knows how sure it is while it does not track.
const tracked = (state: WindowState, of: (state: WindowState) => number) => (state.mode === TRACKING ? of(state) : null);
const one = (of: (state: WindowState) => number | null): Curve[] => [{ label: "", color: BLUE, of }];
const xyz = (of: (state: WindowState) => number[]): Curve[] => [
  { label: "x", color: BLUE, of: (s) => of(s)[0]! },
  { label: "y", color: ORANGE, dash: [6, 3], of: (s) => of(s)[1]! },
  { label: "z", color: GREEN, dash: [2, 2], of: (s) => of(s)[2]! },
];

const PLANS: Plan[] = [
  { title: "Velocity", unit: "m/s", digits: 2, curves: xyz((s) => s.velocity) },
  { title: "σ position", unit: "mm", digits: 1, curves: one((s) => tracked(s, () => 1000 * sigma(s, 0))) },
  { title: "σ rotation", unit: "°", digits: 2, curves: one((s) => tracked(s, () => (180 / Math.PI) * sigma(s, 3))) },
  { title: "Gyro bias", unit: "rad/s", digits: 3, curves: xyz((s) => s.gyroBias) },
  { title: "Acc. bias", unit: "m/s²", digits: 3, curves: xyz((s) => s.accelBias) },
  {
    title: "Time",
    unit: "ms",
    digits: 0,
    curves: [
      { label: "solve", color: BLUE, of: (s) => s.solveMs },
      { label: "total", color: ORANGE, dash: [6, 3], of: (s) => s.totalMs },
      { label: "latency", color: GREEN, dash: [2, 2], of: (s) => (s.latencyMs < 0 ? null : s.latencyMs) },
    ],
  },
  { title: "Near events", unit: "%", digits: 0, curves: one((s) => (s.near == null ? null : 100 * s.near)) },
];

class Plot {
  private plot: uPlot | null = null;
  private readonly place = document.createElement("div");
  private readonly newest = document.createElement("span");

  constructor(parent: HTMLElement, private readonly plan: Plan) {
    const box = document.createElement("div");
    box.className = "plot";
    const title = document.createElement("h2");
    title.innerHTML = `<b>${plan.title}</b><i>${plan.unit}</i>`;
    for (const curve of plan.curves.filter(({ label }) => label)) {
      const name = document.createElement("i");
      name.textContent = curve.label;
      name.style.color = curve.color;
      title.append(name);
    }
    if (plan.curves.length === 1) title.append(this.newest);
    box.append(title, this.place);
    parent.append(box);
    new ResizeObserver(() => this.fit()).observe(box);
    this.make();
    onThemeChange(() => this.make());
  }

  draw(seconds: number[], states: WindowState[]): void {
    const data = this.plan.curves.map((curve) => states.map(curve.of));
    this.plot?.setData([seconds, ...data]);
    const last = states.at(-1);
    const newest = last ? this.plan.curves[0]!.of(last) : null;
    this.newest.textContent = last ? (newest?.toFixed(this.plan.digits) ?? "–") : "";
  }

  private make(): void {
    this.plot?.destroy();
    const axis = { stroke: color("soft"), grid: { stroke: color("line"), width: 1 }, ticks: { show: false }, font: "10px system-ui" };
    this.plot = new uPlot(
      {
        ...this.size(),
        legend: { show: false },
        cursor: { show: false },
        scales: { x: { time: false, range: (_, min) => [Math.min(min ?? 0, -SHORTEST_S), 0] } },
        axes: [
          { ...axis, size: 22, values: (_, ticks) => ticks.map((t) => (t === 0 ? "now" : `${t} s`.replace("-", "−"))), space: 50 },
          { ...axis, size: 42, space: 26 },
        ],
        series: [{}, ...this.plan.curves.map((c) => ({ stroke: c.color, width: 1.5, dash: c.dash, points: { show: false } }))],
      },
      [[], ...this.plan.curves.map(() => [])],
      this.place,
    );
  }

  private size(): { width: number; height: number } {
    return { width: Math.max(120, this.place.clientWidth), height: 140 };
  }

  private fit(): void {
    this.plot?.setSize(this.size());
  }
}

// The last minute of the window's states.
export class Plots {
  private readonly plots = PLANS.map((plan) => new Plot(element("plots"), plan));
  private states: WindowState[] = [];
  private changed = true;

  // `pause`: ms to leave between two drawings where the computer is slow.
  constructor(private readonly pause: () => number) {
    const draw = () => {
      this.draw();
      setTimeout(draw, Math.max(REDRAW_MS, this.pause()));
    };
    draw();
  }

  add(state: WindowState): void {
    const last = this.states.at(-1);
    if (last && state.utime <= last.utime) this.states = []; // the replay went back, or the past comes again
    this.states.push(state);
    this.changed = true;
  }

  clear(): void {
    this.states = [];
    this.changed = true;
  }

  private draw(): void {
    if (!this.changed || document.hidden) return;
    this.changed = false;
    const empty = this.states.length === 0;
    setText("plots-empty", empty ? "no estimate yet: the last minute of velocity, uncertainty, biases and times comes here" : "");
    const now = this.states.at(-1)?.utime ?? 0;
    const first = this.states.findIndex((state) => state.utime > now - 1e6 * SPAN_S);
    this.states.splice(0, Math.max(0, first));
    const seconds = this.states.map((state) => 1e-6 * (state.utime - now));
    for (const plot of this.plots) plot.draw(seconds, this.states);
  }
}
