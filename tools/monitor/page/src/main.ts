import "uplot/dist/uPlot.min.css";
import "./style.css";
import { Connection, type Handler } from "./connection";
import { element, setText } from "./dom";
import type { MapPiece, Picture, Pose, WindowState } from "./frames";
import { HintTool } from "./hint_tool";
import { MapView, type View } from "./map_view";
import { Plots } from "./plots";
import { ReplayBar } from "./replay_bar";
import { ServicesView } from "./services_view";
import type { Answer, Mode, Places, Status } from "./status";
import { SurfaceView } from "./surface_view";

const SIGNS = { tracking: "✓", bootstrapping: "…", lost: "✗", none: "" };

class Page implements Handler {
  private readonly canvas = element<HTMLCanvasElement>("map");
  private readonly mapView = new MapView(this.canvas);
  private readonly surface = new SurfaceView();
  private readonly plots = new Plots();
  private readonly connection = new Connection(this);
  private readonly services = new ServicesView((command) => this.connection.send({ order: "restart", command }));
  private readonly replay = new ReplayBar((order) => this.connection.send(order));
  private readonly hint = new HintTool(this.mapView, this.canvas, (order) => this.connection.send(order));
  private lastMode: Mode | null = null;
  private waiting = "";
  private online = false;

  constructor() {
    for (const button of document.querySelectorAll<HTMLButtonElement>("#views button")) {
      button.onclick = () => this.setView(button.dataset.view as View);
    }
    element("clear-trail").onclick = () => this.mapView.clearTrail();
    const enlarge = element<HTMLSelectElement>("enlarge");
    enlarge.onchange = () => (this.mapView.enlarge = Number(enlarge.value));
    const legend = [["accent", "estimate"], ["wait", "truth"], ["bad", "pose to give"], ["soft", "candidate of a search"]];
    element("map-legend").innerHTML = legend
      .map(([name, text]) => `<span><i style="background:var(--${name})"></i>${text}</span>`)
      .join("");
  }

  connected(yes: boolean): void {
    this.online = yes;
    this.showMode();
  }

  pose(pose: Pose): void {
    this.mapView.setPose(pose);
    setText("position", pose.position.map((x) => x.toFixed(2).padStart(6)).join(" ") + " m");
    setText("speed", `${Math.hypot(...pose.velocity).toFixed(2)} m/s`);
  }

  truth(pose: Pose): void {
    this.mapView.setTruth(pose);
  }

  window(state: WindowState): void {
    this.mapView.setWindow(state);
    this.plots.add(state);
    setText("latency", state.latencyMs < 0 ? `${state.totalMs.toFixed(0)} ms solve` : `${state.latencyMs.toFixed(0)} ms`);
  }

  picture(picture: Picture): void {
    this.surface.show(picture);
    // Once it is on the screen: what cannot be drawn in time is not asked for. A hidden page draws nothing.
    if (document.hidden) setTimeout(() => this.connection.send({ order: "drawn" }), 1000);
    else requestAnimationFrame(() => this.connection.send({ order: "drawn" }));
  }

  map(piece: MapPiece): void {
    this.mapView.addMap(piece);
  }

  status(status: Status): void {
    this.waiting = status.waiting;
    this.showMode();
    this.services.show(status);
    this.replay.show(status);
    this.mapView.setCamera(status.camera ?? null);
    this.hint.setCamera(status.camera ?? null, status.read_only);
    const map = status.map;
    const points = map ? `${map.known.toLocaleString("en")} of ${map.total.toLocaleString("en")} map points · ` : "";
    setText("about", `${points}${status.viewers} viewer${status.viewers === 1 ? "" : "s"}${status.read_only ? " · read-only" : ""}`);
  }

  mode(mode: Mode): void {
    this.lastMode = mode;
    if (mode.mode === "tracking") this.mapView.setPlaces([]);
    this.showMode();
  }

  places(places: Places): void {
    this.mapView.setPlaces(this.lastMode?.mode === "tracking" ? [] : places.places);
  }

  answer(answer: Answer): void {
    setText("answer", answer.text);
    element("answer").classList.toggle("bad", !answer.ok);
  }

  private setView(view: View): void {
    this.mapView.setView(view);
    for (const button of document.querySelectorAll<HTMLButtonElement>("#views button")) {
      button.setAttribute("aria-pressed", String(button.dataset.view === view));
    }
  }

  private showMode(): void {
    const mode = this.online && !this.waiting ? (this.lastMode?.mode ?? "none") : "none";
    element("mode").dataset.mode = mode;
    setText("mode-sign", SIGNS[mode]);
    setText("mode-name", mode === "none" ? "no data" : mode);
    const reason = this.lastMode?.reason ?? "nothing heard of the tracker yet";
    setText("reason", this.online ? this.waiting || reason : "the monitor does not answer; trying again");
  }
}

new Page();
