import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { Body, ellipsoidMatrix, mountOf } from "./body";
import { color, isDark, onThemeChange } from "./dom";
import type { MapPiece, Pose, WindowState } from "./frames";
import { MapCloud } from "./map_cloud";
import type { CameraInfo, Places } from "./status";
import { Trail } from "./trail";

const SURE = 4.5; // standard deviations: chance stays below (lcmtypes/places_t.lcm)

export type View = "orbit" | "follow" | "camera";

// From three's camera (looks along -z, y up) to ours (looks along z, y down).
const TURN = new THREE.Quaternion(1, 0, 0, 0);

// The map in 3-D, with the body, its path and what is known of its uncertainty. Draws only when something has changed.
export class MapView {
  readonly cloud = new MapCloud();
  readonly ghost = new Body(false); // a pose that is about to be given
  readonly camera = new THREE.PerspectiveCamera(55, 1, 0.02, 500);
  private readonly renderer: THREE.WebGLRenderer;
  private readonly scene = new THREE.Scene();
  private readonly controls: OrbitControls;
  private readonly body = new Body(true);
  private readonly truth = new Body(false);
  private candidates: Body[] = [];
  private readonly trail = new Trail();
  private readonly truthTrail = new Trail();
  private readonly ellipsoid: THREE.Mesh<THREE.SphereGeometry, THREE.MeshBasicMaterial>;
  private view: View = "orbit";
  private readonly outside = new THREE.Vector3(); // where it was looked from before the camera's view
  private info: CameraInfo | null = null;
  private framed = 0; // points in the map when it was last brought into view
  private posed = false; // a pose has come
  private touched = false; // by the user: no more framing
  private dirty = true;
  enlarge = 10;

  constructor(private readonly canvas: HTMLCanvasElement) {
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.camera.up.set(0, 0, 1);
    this.camera.position.set(-3, -4, 3);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => (this.dirty = true));
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
    const draw = () => {
      requestAnimationFrame(draw);
      if (!this.dirty || document.hidden) return;
      this.dirty = false;
      this.renderer.render(this.scene, this.camera);
    };
    draw();
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
    this.body.object.visible = this.posed && view !== "camera";
    this.camera.fov = 55;
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
    this.info = info;
    for (const body of [this.body, this.truth, this.ghost]) body.setCamera(info);
    this.dirty = true;
  }

  addMap(piece: MapPiece): void {
    this.cloud.add(piece);
    if (!this.touched && this.view === "orbit" && this.cloud.count > 1.3 * this.framed) this.frameMap();
    this.dirty = true;
  }

  setPose(pose: Pose): void {
    const before = this.body.object.position.clone();
    this.body.place(pose.position, pose.orientation);
    this.posed = true;
    this.trail.add(pose);
    if (this.view === "camera") {
      this.lookAsCamera();
    } else if (this.view === "follow") {
      this.camera.position.add(this.body.object.position).sub(before);
      this.controls.target.copy(this.body.object.position);
      this.controls.update();
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
    this.ellipsoid.visible = this.view !== "camera";
    this.dirty = true;
  }

  // Candidates of a search for the start: the surer, the more visible.
  setPlaces(places: Places["places"]): void {
    for (const body of this.candidates) {
      this.scene.remove(body.object);
      body.dispose();
    }
    this.candidates = places.map((place) => {
      const body = new Body(false);
      body.setCamera(this.info);
      body.setColor(color("soft"));
      body.setOpacity(place.significance >= SURE ? 1 : 0.35);
      body.place(place.position, place.orientation);
      this.scene.add(body.object);
      return body;
    });
    this.dirty = true;
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
    if (!mount || !this.posed) return null;
    this.body.object.updateMatrix();
    return this.body.object.matrix.clone().multiply(mount);
  }

  // The body in the middle, from where it is looked at now but not from farther away than some metres.
  private approach(): void {
    const from = this.camera.position.clone().sub(this.controls.target).clampLength(0.3, 3);
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

  private frameMap(): void {
    this.framed = this.cloud.count;
    const center = this.cloud.box.getCenter(new THREE.Vector3());
    const radius = Math.max(0.5, this.cloud.box.getSize(new THREE.Vector3()).length() / 2);
    this.controls.target.copy(center);
    this.camera.position.copy(center).add(new THREE.Vector3(-0.75, -1.05, 0.95).multiplyScalar(radius));
    this.controls.update();
  }

  private paint(): void {
    this.renderer.setClearColor(color("panel"));
    this.cloud.setColors(isDark());
    this.trail.object.material.color.set(color("accent"));
    this.body.setColor(color("accent"));
    this.ellipsoid.material.color.set(color("accent"));
    this.truth.setColor(color("wait"));
    this.truthTrail.object.material.color.set(color("wait"));
    this.ghost.setColor(color("bad"));
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
