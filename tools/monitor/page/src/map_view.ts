import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { AxesCorner } from "./axes_corner";
import { Body, ellipsoidMatrix, mountOf } from "./body";
import { color, isDark, onThemeChange } from "./dom";
import { FramePace } from "./frame_pace";
import type { MapPiece, Pose, WindowState } from "./frames";
import { MapCloud } from "./map_cloud";
import type { CameraInfo } from "./status";
import { Trail } from "./trail";

export type View = "orbit" | "follow" | "camera";

// From three's camera (looks along -z, y up) to ours (looks along z, y down).
const TURN = new THREE.Quaternion(1, 0, 0, 0);
const FOV = 50; // degrees
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
  readonly camera = new THREE.PerspectiveCamera(FOV, 1, 0.02, 1000);
  readonly pace = new FramePace();
  private readonly renderer: THREE.WebGLRenderer;
  private readonly controls: OrbitControls;
  private readonly body = new Body({ width: 2.5, axes: true, filled: true });
  private readonly truth = new Body({ width: 1.5 });
  private readonly trail = new Trail(2);
  private readonly truthTrail = new Trail(1.5);
  private readonly ellipsoid: THREE.Mesh<THREE.SphereGeometry, THREE.MeshBasicMaterial>;
  private readonly axes = new AxesCorner();
  private grid: THREE.GridHelper | null = null;
  private view: View = "orbit";
  private readonly outside = new THREE.Vector3(); // where it was looked from before the camera's view
  private info: CameraInfo | null = null;
  private framed = 0; // points in the map when it was last brought into view
  private touched = false; // by the user: no more framing
  private dirty = true;
  private turning = false; // by the user, who should not wait
  private known = true; // where the body is now
  enlarge = 10;
  onLegend: () => void = () => {};

  constructor(private readonly canvas: HTMLCanvasElement) {
    const software = isSoftware();
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: !software });
    this.renderer.info.autoReset = true;
    const ratio = software ? 1 : Math.min(devicePixelRatio, 2);
    this.renderer.setPixelRatio(ratio);
    this.cloud.setPixelRatio(ratio);
    this.camera.up.set(0, 0, 1);
    this.camera.position.set(-3, -4, 3);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => (this.dirty = this.turning = true));
    this.controls.addEventListener("start", () => (this.touched = true));
    const material = new THREE.MeshBasicMaterial({ transparent: true, opacity: 0.4, depthWrite: false });
    this.ellipsoid = new THREE.Mesh(new THREE.SphereGeometry(1, 24, 16), material);
    this.ellipsoid.matrixAutoUpdate = false;
    this.ellipsoid.visible = false;
    this.scene.add(this.cloud.object, this.trail.object, this.truthTrail.object);
    this.scene.add(this.body.object, this.truth.object, this.ghost.object, this.ellipsoid);
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

  get hasPose(): boolean {
    return this.body.object.userData.placed === true;
  }

  get hasTruth(): boolean {
    return this.truth.object.visible;
  }

  get gridStep(): number {
    return this.grid ? (this.grid.userData.step as number) : 0;
  }

  invalidate(): void {
    this.dirty = true;
  }

  setView(view: View): void {
    if (view === this.view) return;
    if (view === "camera") this.outside.copy(this.camera.position);
    else if (this.view === "camera") this.camera.position.copy(this.outside);
    this.view = view;
    this.controls.enabled = view !== "camera";
    this.body.object.visible = this.hasPose && view !== "camera";
    this.camera.fov = FOV;
    this.camera.updateProjectionMatrix();
    if (view === "camera") this.lookAsCamera();
    else if (view === "follow") this.approach();
    if (view !== "camera") this.controls.update();
    this.dirty = true;
  }

  // The left button is for something else; turning is not possible, moving and zooming are.
  reserveLeftButton(yes: boolean): void {
    this.controls.mouseButtons.LEFT = yes ? null : THREE.MOUSE.ROTATE;
  }

  setCamera(info: CameraInfo | null): void {
    if (JSON.stringify(info) === JSON.stringify(this.info)) return;
    this.info = info;
    for (const body of [this.body, this.truth, this.ghost]) body.setCamera(info);
    this.dirty = true;
  }

  addMap(piece: MapPiece): void {
    this.cloud.add(piece);
    if (!this.touched && this.view === "orbit" && this.cloud.count > 1.3 * this.framed) this.frameMap();
    this.dirty = true;
  }

  // Where the body was; setPose says where it is.
  addPast(pose: Pose): void {
    this.trail.add(pose);
  }

  addTruthPast(pose: Pose): void {
    this.truthTrail.add(pose);
  }

  setPose(pose: Pose): void {
    const before = this.body.object.position.clone();
    this.body.place(pose.position, pose.orientation);
    this.body.object.userData.placed = true;
    this.trail.add(pose);
    if (this.view === "camera") {
      this.lookAsCamera();
    } else if (this.view === "follow") {
      this.camera.position.add(this.body.object.position).sub(before);
      this.controls.target.copy(this.body.object.position);
      this.controls.update();
      this.turning = false;
    }
    this.dirty = true;
  }

  setTruth(pose: Pose): void {
    this.truth.place(pose.position, pose.orientation);
    this.truthTrail.add(pose);
    this.dirty = true;
  }

  setWindow(state: WindowState): void {
    this.ellipsoid.matrix.copy(ellipsoidMatrix(state.covariance, state.position, 3 * this.enlarge));
    this.ellipsoid.visible = this.known && this.view !== "camera";
    this.dirty = true;
  }

  // Whether the newest pose holds; else it is where the body was last.
  setKnown(yes: boolean): void {
    if (yes === this.known) return;
    this.known = yes;
    if (!yes) this.ellipsoid.visible = false;
    this.paintBody();
    this.onLegend();
  }

  get isKnown(): boolean {
    return this.known;
  }

  // Nothing is known of a body.
  forget(): void {
    for (const part of [this.body.object, this.truth.object, this.ellipsoid]) part.visible = false;
    this.body.object.userData.placed = false;
    this.clearTrail();
  }

  clearTrail(): void {
    this.trail.clear();
    this.truthTrail.clear();
    this.dirty = true;
  }

  // The ray through a point of the canvas, CSS pixels.
  ray(x: number, y: number): THREE.Ray {
    const box = this.canvas.getBoundingClientRect();
    const at = new THREE.Vector2((2 * (x - box.left)) / box.width - 1, 1 - (2 * (y - box.top)) / box.height);
    const caster = new THREE.Raycaster();
    caster.setFromCamera(at, this.camera);
    return caster.ray;
  }

  // T_map_camera of the newest pose; null where there is none.
  lastCamera(): THREE.Matrix4 | null {
    const mount = mountOf(this.info);
    if (!mount || !this.hasPose) return null;
    this.body.object.updateMatrix();
    return this.body.object.matrix.clone().multiply(mount);
  }

  // The whole map in view.
  frameMap(): void {
    this.framed = this.cloud.count;
    if (this.cloud.box.isEmpty()) return;
    const center = this.cloud.box.getCenter(new THREE.Vector3());
    const radius = Math.max(0.3, this.cloud.box.getSize(new THREE.Vector3()).length() / 2);
    const narrow = Math.min(1, this.camera.aspect);
    const distance = (0.78 * radius) / Math.sin((FOV * Math.PI) / 360) / narrow;
    this.controls.target.copy(center);
    this.camera.position.copy(center).add(new THREE.Vector3(-0.52, -0.68, 0.52).normalize().multiplyScalar(distance));
    this.controls.update();
    this.layGrid(center, radius);
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

  // The floor, in steps of 1, 2 or 5 times a power of ten metres.
  private layGrid(center: THREE.Vector3, radius: number): void {
    if (this.grid) this.scene.remove(this.grid);
    this.grid?.dispose();
    const rough = radius / 3;
    const power = 10 ** Math.floor(Math.log10(rough));
    const step = power * ([5, 2, 1].find((k) => k * power <= rough) ?? 1);
    const n = 2 * Math.ceil(radius / step);
    this.grid = new THREE.GridHelper(n * step, n);
    this.grid.userData.step = step;
    this.grid.rotateX(Math.PI / 2);
    this.grid.position.set(step * Math.round(center.x / step), step * Math.round(center.y / step), this.cloud.box.min.z);
    this.paintGrid();
    this.scene.add(this.grid);
    this.onLegend();
  }

  private paintGrid(): void {
    if (!this.grid) return;
    const material = this.grid.material as THREE.LineBasicMaterial;
    material.vertexColors = false;
    material.color.set(color("grid"));
    material.needsUpdate = true;
    this.grid.renderOrder = -1;
    material.depthWrite = false;
  }

  // The body in the middle, from where it is looked at now but not from farther away than some metres.
  private approach(): void {
    const from = this.camera.position.clone().sub(this.controls.target).clampLength(0.3, 2.5);
    this.controls.target.copy(this.body.object.position);
    this.camera.position.copy(this.controls.target).add(from);
  }

  private lookAsCamera(): void {
    const T = this.lastCamera();
    if (!T || !this.info) return;
    T.decompose(this.camera.position, this.camera.quaternion, new THREE.Vector3());
    this.camera.quaternion.multiply(TURN);
    this.camera.fov = (2 * Math.atan(this.info.height / 2 / this.info.fy) * 180) / Math.PI;
    this.camera.updateProjectionMatrix();
    this.body.object.visible = false;
    this.ellipsoid.visible = false;
  }

  private paint(): void {
    this.renderer.setClearColor(color("panel"));
    this.cloud.setTheme(isDark());
    this.trail.setColor(color("accent"));
    this.paintBody();
    this.ellipsoid.material.color.set(color("accent"));
    this.truth.setColor(color("truth"));
    this.truthTrail.setColor(color("truth"));
    this.ghost.setColor(color("bad"));
    this.paintGrid();
    this.dirty = true;
  }

  private paintBody(): void {
    this.body.setColor(color(this.known ? "accent" : "soft"));
    this.body.setOpacity(this.known ? 1 : 0.5);
    this.dirty = true;
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.canvas.parentElement!;
    if (!clientWidth || !clientHeight) return;
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / clientHeight;
    this.camera.updateProjectionMatrix();
    this.dirty = true;
  }
}
