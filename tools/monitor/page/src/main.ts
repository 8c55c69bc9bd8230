import "uplot/dist/uPlot.min.css";
import "./style.css";
import { aboutText } from "./about";
import { Candidates } from "./candidates";
import { Connection, type Handler } from "./connection";
import { element, onThemeChange, setMarked, setText } from "./dom";
import { showEmptyMap } from "./empty_map";
import { TRACKING, type History, type MapPiece, type Picture, type Pose, type WindowState } from "./frames";
import { headline, SIGNS } from "./headline";
import { HintTool } from "./hint_tool";
import { Latencies } from "./latency";
import { showLegend } from "./legend";
import { MapView } from "./map_view";
import { Plots } from "./plots";
import { positionText, sigmasText, speedText } from "./readout";
import { ReplayBar } from "./replay_bar";
import { ServicesView } from "./services_view";
import type { Answer, Drawn, Mode, Places, Status } from "./status";
import { SurfaceView } from "./surface_view";
import type { View } from "./viewpoint";

const ANSWER_MS = 6000; // for so long an answer stays

class Page implements Handler {
  private readonly canvas = element<HTMLCanvasElement>("map");
  private readonly mapView = new MapView(this.canvas);
  private readonly plots = new Plots(() => this.mapView.pace.pause);
  private readonly pictureLatencies = new Latencies();
  private readonly connection: Connection;
  private readonly surface: SurfaceView;
  private readonly services: ServicesView;
  private readonly replay: ReplayBar;
  private readonly hint: HintTool;
  private readonly candidates: Candidates;
  private lastMode: Mode | null = null;
  private lastStatus: Status | null = null;
  private lastWindow: WindowState | null = null;
  private lastPose: Pose | null = null;
  private online = true;
  private pictured = false; // since the line is open
  private answerTimer = 0;

  constructor() {
    this.connection = new Connection(this);
    const send = this.connection.send.bind(this.connection);
    this.surface = new SurfaceView((picture) => this.drew(picture));
    this.services = new ServicesView((command) => send({ order: "restart", command }));
    this.replay = new ReplayBar(send);
    this.hint = new HintTool(this.mapView, this.canvas, send, {
      opened: () => this.leaveCameraView(),
      said: (text, ok) => this.say(text, ok),
      tries: (pixels) => this.surface.tryPoints(pixels),
    });
    this.candidates = new Candidates(this.mapView, send);
    for (const button of document.querySelectorAll<HTMLButtonElement>("#views button")) {
      button.onclick = () => this.setView(button.dataset.view as View);
    }
    element("whole").onclick = () => {
      this.setView("orbit");
      this.mapView.frameMap();
    };
    element("clear-trail").onclick = () => this.mapView.clearTrail();
    const enlarge = element<HTMLSelectElement>("enlarge");
    enlarge.onchange = () => {
      this.mapView.enlarge = Number(enlarge.value);
      if (this.lastWindow) this.mapView.setWindow(this.lastWindow);
    };
    this.mapView.onLegend = () => this.showLegend();
    onThemeChange(() => this.showLegend());
    setInterval(() => this.showAbout(), 1000);
  }

  connected(yes: boolean): void {
    this.online = yes;
    if (yes) this.forget();
    this.showHeadline();
  }

  pose(pose: Pose): void {
    const first = !this.mapView.body.hasPose;
    this.mapView.setPose(pose);
    this.lastPose = pose;
    this.showReadout();
    if (first) this.showLegend();
  }

  truth(pose: Pose): void {
    const first = !this.mapView.hasTruth;
    this.mapView.setTruth(pose);
    if (first) this.showLegend();
  }

  window(state: WindowState): void {
    this.lastWindow = state;
    this.mapView.setWindow(state);
    this.plots.add({ ...state, near: this.surface.near });
    this.showReadout();
    if (state.latencyMs < 0) this.pictureLatencies.clear();
    this.showLatency();
  }

  history(history: History): void {
    for (const pose of history.truths) this.mapView.addTruthPast(pose);
    for (const state of history.windows) {
      this.mapView.body.addPast(state);
      this.plots.add(state);
    }
    const last = history.windows.at(-1);
    if (last) this.window({ ...last, utime: last.utime + 1 });
  }

  picture(picture: Picture): void {
    this.surface.show(picture);
  }

  drawn(drawn: Drawn): void {
    this.pictureLatencies.add(drawn.picture_ms);
    this.showLatency();
  }

  map(piece: MapPiece): void {
    this.mapView.addMap(piece);
    this.showEmpty();
  }

  status(status: Status): void {
    this.lastStatus = status;
    this.services.show(status);
    this.replay.show(status);
    this.mapView.setCamera(status.camera ?? null);
    this.hint.setCamera(status.camera ?? null, status.read_only);
    this.candidates.setCamera(status.camera ?? null, status.read_only);
    const level = status.services.find((s) => s.name === "window_optimizer")?.counters["overload.level"];
    setText("overload", level === undefined ? "–" : level === 0 ? "none" : `level ${level} of 4`);
    element("overload").dataset.kind = level ? "wait" : "";
    this.showHeadline();
    this.showEmpty();
    this.showAbout();
  }

  mode(mode: Mode): void {
    this.lastMode = mode;
    if (mode.mode === "tracking") this.candidates.show([]);
    this.hint.hear(mode);
    this.showReadout();
    this.showHeadline();
  }

  places(places: Places): void {
    this.candidates.show(this.lastMode?.mode === "tracking" ? [] : places.places);
  }

  answer(answer: Answer): void {
    this.say(answer.text, answer.ok);
  }

  private say(text: string, ok: boolean): void {
    setText("answer", text);
    element("answer").classList.toggle("bad", !ok);
    clearTimeout(this.answerTimer);
    this.answerTimer = window.setTimeout(() => setText("answer", ""), ANSWER_MS);
  }

  // Figures hold while it tracks; else there is where the body was last.
  private showReadout(): void {
    const tracks = this.lastMode?.mode === "tracking";
    this.mapView.setKnown(tracks);
    const place = element("position");
    place.toggleAttribute("data-stale", !tracks);
    place.title = tracks || !this.lastPose ? "" : "Where it was last: it is not tracked now";
    const { lastPose: pose, lastWindow: window } = this;
    setText("position", pose ? positionText(pose) : "–");
    setText("speed", tracks && pose ? speedText(pose) : "–");
    setText("sigma", tracks && window?.mode === TRACKING ? sigmasText(window) : "–");
  }

  // All that is known comes again, perhaps of another pipeline.
  private forget(): void {
    this.pictured = false;
    this.lastMode = this.lastWindow = this.lastPose = null;
    this.surface.near = null;
    this.pictureLatencies.clear();
    this.plots.clear();
    this.mapView.forget();
    this.candidates.show([]);
    this.showReadout();
    this.showLatency();
    this.showLegend();
  }

  // The first picture may be of long ago: it says nothing of how late pictures are.
  private drew(picture: Picture): void {
    this.connection.send({ order: "drawn", utime: this.pictured ? picture.utime : 0 });
    this.pictured = true;
  }

  private setView(view: View): void {
    this.mapView.setView(view);
    for (const button of document.querySelectorAll<HTMLButtonElement>("#views button")) {
      button.setAttribute("aria-pressed", String(button.dataset.view === view));
    }
  }

  private leaveCameraView(): void {
    if (document.querySelector('#views [data-view="camera"]')?.getAttribute("aria-pressed") === "true") this.setView("orbit");
  }

  private showHeadline(): void {
    const { kind, name, reason } = headline({ online: this.online, status: this.lastStatus, mode: this.lastMode, window: this.lastWindow, near: this.surface.near });
    element("mode").dataset.kind = kind;
    setText("mode-sign", SIGNS[kind]);
    setText("mode-name", name);
    setMarked("reason", reason);
    element("reason").title = reason;
    document.title = `${name} – EVIT monitor`;
  }

  private showLatency(): void {
    const pose = this.lastWindow?.latencyMs ?? -1;
    const [median, most] = [this.pictureLatencies.quantile(0.5), this.pictureLatencies.quantile(0.99)];
    const text = (ms: number | null) => (ms === null || ms < 0 ? "–" : `${ms.toFixed(0)} ms`);
    setText("latency", pose < 0 && median === null ? "–" : `${text(pose)}, ${text(median)}`);
    element("latency").dataset.pictureP50 = String(median ?? "");
    element("latency").dataset.pictureP99 = String(most ?? "");
  }

  private showEmpty(): void {
    const empty = this.mapView.cloud.count === 0;
    showEmptyMap(empty && this.online, this.lastStatus);
    if (empty) this.showLegend();
  }

  private showLegend(): void {
    showLegend(this.mapView, { poseSent: this.hint.waits, candidates: this.candidates.any });
  }

  private showAbout(): void {
    const status = this.lastStatus;
    if (!status) return;
    const figures = this.mapView.figures;
    Object.assign(this.canvas.dataset, figures);
    setText("about", aboutText(status, figures));
  }
}

new Page();
