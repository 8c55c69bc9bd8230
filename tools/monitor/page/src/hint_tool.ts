import * as THREE from "three";
import { mountOf } from "./body";
import type { Order } from "./connection";
import { element } from "./dom";
import type { MapView } from "./map_view";
import type { CameraInfo } from "./status";

const FIELDS = ["x", "y", "z", "yaw", "pitch"] as const;
type Field = (typeof FIELDS)[number];
const DEGREES = 180 / Math.PI;

// T_map_camera of a level camera: heading from the map's x axis, tilt upwards, rad.
function cameraPose(position: THREE.Vector3, yaw: number, pitch: number): THREE.Matrix4 {
  const forward = new THREE.Vector3(Math.cos(pitch) * Math.cos(yaw), Math.cos(pitch) * Math.sin(yaw), Math.sin(pitch));
  const right = new THREE.Vector3(Math.sin(yaw), -Math.cos(yaw), 0);
  const down = forward.clone().cross(right);
  return new THREE.Matrix4().makeBasis(right, down, forward).setPosition(position);
}

// Gives the tracker a pose: press on the map for the place, drag for the heading, or type, or take the view.
export class HintTool {
  private readonly panel = element("map-panel");
  private readonly form = element<HTMLFormElement>("hint-form");
  private readonly button = element<HTMLButtonElement>("hint");
  private camera: CameraInfo | null = null;
  private pressed = false;

  constructor(
    private readonly view: MapView,
    private readonly canvas: HTMLCanvasElement,
    private readonly send: (order: Order) => void,
    private readonly opened: () => void,
  ) {
    this.button.onclick = () => this.toggle(this.form.hidden);
    element("hint-cancel").onclick = () => this.toggle(false);
    element("hint-view").onclick = () => this.takeView();
    element("hint-last").onclick = () => this.takeLast();
    this.form.onsubmit = (event) => {
      event.preventDefault();
      this.submit();
    };
    document.addEventListener("keydown", (event) => {
      if (event.key === "Escape" && !this.form.hidden) this.toggle(false);
    });
    this.form.oninput = () => this.drawGhost();
    canvas.addEventListener("pointerdown", (event) => this.press(event));
    canvas.addEventListener("pointermove", (event) => this.drag(event));
    canvas.addEventListener("pointerup", () => (this.pressed = false));
  }

  setCamera(camera: CameraInfo | null, readOnly: boolean): void {
    this.camera = camera;
    const known = mountOf(camera) !== null;
    this.button.disabled = readOnly || !known;
    this.button.title = readOnly
      ? "this monitor is read-only"
      : known
        ? "Tell the tracker where the body is"
        : "needs the camera's place on the body: evit monitor --rig FILE, or a tracker that has run";
  }

  private field(name: Field): HTMLInputElement {
    return element<HTMLInputElement>(`hint-${name}`);
  }

  private value(name: Field): number {
    return Number(this.field(name).value) || 0;
  }

  private set(name: Field, value: number): void {
    this.field(name).value = value.toFixed(name === "yaw" || name === "pitch" ? 0 : 2);
  }

  private toggle(on: boolean): void {
    this.form.hidden = !on;
    this.button.setAttribute("aria-pressed", String(on));
    this.panel.classList.toggle("hinting", on);
    this.view.reserveLeftButton(on);
    this.view.ghost.object.visible = false;
    if (on) {
      this.opened();
      this.takeLast();
    }
    this.view.invalidate();
  }

  private takeLast(): void {
    const T = this.view.lastCamera();
    if (T) return this.fill(T);
    const center = this.view.cloud.box.isEmpty()
      ? new THREE.Vector3()
      : this.view.cloud.box.getCenter(new THREE.Vector3());
    this.fill(cameraPose(center, 0, 0));
  }

  private takeView(): void {
    const camera = this.view.camera;
    const forward = camera.getWorldDirection(new THREE.Vector3());
    this.fill(cameraPose(camera.position, Math.atan2(forward.y, forward.x), Math.asin(forward.z)));
  }

  private fill(T_map_camera: THREE.Matrix4): void {
    const p = new THREE.Vector3().setFromMatrixPosition(T_map_camera);
    const forward = new THREE.Vector3().setFromMatrixColumn(T_map_camera, 2);
    this.set("x", p.x);
    this.set("y", p.y);
    this.set("z", p.z);
    this.set("yaw", Math.atan2(forward.y, forward.x) * DEGREES);
    this.set("pitch", Math.asin(THREE.MathUtils.clamp(forward.z, -1, 1)) * DEGREES);
    this.drawGhost();
  }

  // Where a point of the canvas meets the height that is set.
  private onPlane(event: PointerEvent): THREE.Vector3 | null {
    const plane = new THREE.Plane(new THREE.Vector3(0, 0, 1), -this.value("z"));
    return this.view.ray(event.clientX, event.clientY).intersectPlane(plane, new THREE.Vector3());
  }

  private press(event: PointerEvent): void {
    if (this.form.hidden || event.button !== 0) return;
    const at = this.onPlane(event);
    if (!at) return;
    this.pressed = true;
    this.canvas.setPointerCapture(event.pointerId);
    this.set("x", at.x);
    this.set("y", at.y);
    this.drawGhost();
  }

  private drag(event: PointerEvent): void {
    if (!this.pressed) return;
    const at = this.onPlane(event);
    if (!at) return;
    const [dx, dy] = [at.x - this.value("x"), at.y - this.value("y")];
    if (Math.hypot(dx, dy) < 0.03) return; // a click, not a direction
    this.set("yaw", Math.atan2(dy, dx) * DEGREES);
    this.drawGhost();
  }

  private bodyPose(): { position: THREE.Vector3; orientation: THREE.Quaternion } | null {
    const mount = mountOf(this.camera);
    if (!mount) return null;
    const place = new THREE.Vector3(this.value("x"), this.value("y"), this.value("z"));
    const T = cameraPose(place, this.value("yaw") / DEGREES, this.value("pitch") / DEGREES).multiply(mount.invert());
    const position = new THREE.Vector3();
    const orientation = new THREE.Quaternion();
    T.decompose(position, orientation, new THREE.Vector3());
    return { position, orientation };
  }

  private drawGhost(): void {
    const pose = this.bodyPose();
    if (pose) this.view.ghost.place(pose.position.toArray(), pose.orientation.toArray());
    this.view.invalidate();
  }

  private submit(): void {
    const pose = this.bodyPose();
    if (!pose) return;
    this.send({ order: "hint", position: pose.position.toArray(), orientation: pose.orientation.toArray() });
    this.toggle(false);
  }
}
