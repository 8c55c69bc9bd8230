import * as THREE from "three";
import { AxesCorner } from "./axes_corner";
import { Body } from "./body";
import { color, isDark, onThemeChange } from "./dom";
import { FloorGrid } from "./floor_grid";
import { FramePace } from "./frame_pace";
import type { MapPiece, Pose, WindowState } from "./frames";
import { MapCloud } from "./map_cloud";
import type { CameraInfo } from "./status";
import { TrackedBody } from "./tracked_body";
import { Trail } from "./trail";
import { type View, Viewpoint } from "./viewpoint";

const FEWEST = 25_000; // points of the map that are drawn on the slowest computer
const ALL = new URLSearchParams(location.search).get("points") === "all"; // in every frame, however slow that is

// Graphics without a GPU: every pixel costs.
function isSoftware(): boolean {
  const gl = document.createElement("canvas").getContext("webgl2");
  const info = gl?.getExtension("WEBGL_debug_renderer_info");
  const name = gl && info ? String(gl.getParameter(info.UNMASKED_RENDERER_WEBGL)) : "";
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software/i.test(name);
}

// The map in 3-D, with the body, its path and what is known of its uncertainty. Draws only when something has changed.
export class MapView {
  readonly cloud = new MapCloud();
  readonly scene = new THREE.Scene();
  readonly ghost = new Body({ width: 2.5, filled: true }); // a pose that is about to be given
  readonly body = new TrackedBody();
  readonly pace = new FramePace();
  private readonly renderer: THREE.WebGLRenderer;
  private readonly viewpoint: Viewpoint;
  private readonly truth = new Body({ width: 1.5 });
  private readonly truthTrail = new Trail(1.5);
  private readonly axes = new AxesCorner();
  private readonly floor = new FloorGrid();
  private info: CameraInfo | null = null;
  private framed = 0; // points in the map when it was last brought into view
  private dirty = true;
  private turning = false; // by the user, who should not wait
  enlarge = 10;
  onLegend: () => void = () => {};

  constructor(private readonly canvas: HTMLCanvasElement) {
    const software = isSoftware();
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: !software });
    this.renderer.info.autoReset = true;
    const ratio = software ? 1 : Math.min(devicePixelRatio, 2);
    this.renderer.setPixelRatio(ratio);
    this.cloud.setPixelRatio(ratio);
    this.viewpoint = new Viewpoint(canvas, () => (this.dirty = this.turning = true));
    this.scene.add(this.cloud.object, this.floor.object, this.truthTrail.object);
    this.scene.add(this.body.object, this.truth.object, this.ghost.object);
    this.paint();
    onThemeChange(() => this.paint());
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement!);
    this.resize();
    const draw = (now: number) => {
      requestAnimationFrame(draw);
      this.draw(now);
    };
    requestAnimationFrame(draw);
  }

  // For people who want to know, and for measurements.
  get figures(): Record<string, number> {
    const { render } = this.renderer.info;
    return { framesPerSecond: this.pace.rate(performance.now()), calls: render.calls, points: this.cloud.count, drawn: this.cloud.drawn };
  }

  get camera(): THREE.PerspectiveCamera {
    return this.viewpoint.camera;
  }

  get hasTruth(): boolean {
    return this.truth.object.visible;
  }

  get gridStep(): number {
    return this.floor.step;
  }

  invalidate(): void {
    this.dirty = true;
  }

  setView(view: View): void {
    if (view === this.viewpoint.view) return;
    this.viewpoint.setView(view, this.body.position);
    this.body.setHidden(view === "camera");
    if (view === "camera") this.lookAsCamera();
    this.dirty = true;
  }

  reserveLeftButton(yes: boolean): void {
    this.viewpoint.reserveLeftButton(yes);
  }

  // The ray through a point of the canvas, CSS pixels.
  ray(x: number, y: number): THREE.Ray {
    return this.viewpoint.ray(x, y);
  }

  setCamera(info: CameraInfo | null): void {
    if (JSON.stringify(info) === JSON.stringify(this.info)) return;
    this.info = info;
    for (const body of [this.body, this.truth, this.ghost]) body.setCamera(info);
    this.dirty = true;
  }

  addMap(piece: MapPiece): void {
    this.cloud.add(piece);
    const grown = this.cloud.count > 1.3 * this.framed;
    if (grown && this.viewpoint.view === "orbit" && !this.viewpoint.touched) this.frameMap();
    this.dirty = true;
  }

  addTruthPast(pose: Pose): void {
    this.truthTrail.add(pose);
  }

  setPose(pose: Pose): void {
    const before = this.body.position.clone();
    this.body.setPose(pose);
    if (this.viewpoint.view === "camera") {
      this.lookAsCamera();
    } else if (this.viewpoint.view === "follow") {
      this.viewpoint.follow(before, this.body.position);
      this.turning = false; // it is not the user who moves
    }
    this.dirty = true;
  }

  setTruth(pose: Pose): void {
    this.truth.place(pose.position, pose.orientation);
    this.truthTrail.add(pose);
    this.dirty = true;
  }

  setWindow(state: WindowState): void {
    this.body.setWindow(state, 3 * this.enlarge);
    this.dirty = true;
  }

  // Whether the newest pose holds.
  setKnown(yes: boolean): void {
    if (yes === this.body.isKnown) return;
    this.body.setKnown(yes);
    this.dirty = true;
    this.onLegend();
  }

  // Nothing is known of a body.
  forget(): void {
    this.body.forget();
    this.truth.object.visible = false;
    this.clearTrail();
  }

  clearTrail(): void {
    this.body.clearTrail();
    this.truthTrail.clear();
    this.dirty = true;
  }

  // The whole map in view.
  frameMap(): void {
    this.framed = this.cloud.count;
    if (this.cloud.box.isEmpty()) return;
    const center = this.cloud.box.getCenter(new THREE.Vector3());
    const radius = Math.max(0.3, this.cloud.box.getSize(new THREE.Vector3()).length() / 2);
    this.viewpoint.frame(center, radius);
    this.floor.lay(center, radius, this.cloud.box.min.z);
    this.onLegend();
    this.dirty = true;
  }

  private draw(now: number): void {
    if (document.hidden) return;
    this.pace.tick(now);
    // All points again once nothing moves any more.
    const complete = !this.dirty && this.cloud.drawn < this.cloud.count && this.pace.still(now);
    if (!complete && !(this.dirty && (this.turning || this.pace.due(now)))) return;
    if (!complete) this.pace.add(now);
    this.cloud.setShare(complete || ALL ? 1 : this.pace.share, FEWEST);
    this.dirty = this.turning = false;
    this.renderer.render(this.scene, this.camera);
    this.axes.draw(this.camera);
  }

  private lookAsCamera(): void {
    const T_map_camera = this.body.lastCamera();
    if (T_map_camera && this.info) this.viewpoint.lookThrough(T_map_camera, this.info);
  }

  private paint(): void {
    this.renderer.setClearColor(color("panel"));
    this.cloud.setTheme(isDark());
    this.body.paint();
    this.truth.setColor(color("truth"));
    this.truthTrail.setColor(color("truth"));
    this.ghost.setColor(color("bad"));
    this.floor.paint();
    this.dirty = true;
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.canvas.parentElement!;
    if (!clientWidth || !clientHeight) return;
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.viewpoint.setAspect(clientWidth / clientHeight);
    this.dirty = true;
  }
}
