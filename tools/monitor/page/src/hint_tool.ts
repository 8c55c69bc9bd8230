import * as THREE from "three";
import { mountOf } from "./body";
import type { Order } from "./connection";
import { element } from "./dom";
import { makeMovable } from "./grip";
import type { MapView } from "./map_view";
import type { CameraInfo, Mode } from "./status";
import { seenFrom } from "./try_pose";

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

export interface HintEvents {
  opened(): void;
  said(text: string, ok: boolean): void; // of a pose that was sent
  tries(pixels: Float32Array | null): void; // the map as the pose in the form sees it; null: no pose is in the form
}

const REFUSED_MS = 2000; // a tracker that is lost for so long after a pose has tried it

// Gives the tracker a pose: the view that looks like the picture of events, or drawn on the map (press for the place, drag
// for the heading), or typed. The pose stays in the map until the tracker has taken or refused it.
export class HintTool {
  private readonly panel = element("map-panel");
  private readonly form = element<HTMLFormElement>("hint-form");
  private readonly button = element<HTMLButtonElement>("hint");
  private readonly draw = element<HTMLButtonElement>("hint-draw");
  private camera: CameraInfo | null = null;
  private pressed = false;
  private sentAt: number | null = null; // ms: a pose was sent, and is neither taken nor refused yet
  private tried = false;

  constructor(
    private readonly view: MapView,
    private readonly canvas: HTMLCanvasElement,
    private readonly send: (order: Order) => void,
    private readonly events: HintEvents,
  ) {
    makeMovable(this.form, element("hint-grip"));
    this.draw.onclick = () => {
      const on = this.draw.getAttribute("aria-pressed") !== "true";
      if (on) this.takeLast(); // at the height of the view itself nothing can be drawn
      this.setDrawing(on);
    };
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

  // What the tracker makes of a pose that was sent.
  hear(mode: Mode): void {
    if (this.sentAt === null) return;
    if (mode.mode === "bootstrapping") this.tried = true;
    if (mode.mode === "tracking") this.settle("the tracker took the pose and is tracking", true);
    const refused = mode.mode === "lost" && (this.tried || performance.now() - this.sentAt > REFUSED_MS);
    if (refused) this.settle(`the tracker does not find the map around the pose sent: ${mode.reason}`, false);
  }

  private settle(text: string, ok: boolean): void {
    this.forget();
    this.events.said(text, ok);
  }

  private forget(): void {
    this.sentAt = null;
    this.tried = false;
    if (this.form.hidden) this.view.ghost.object.visible = false;
    this.view.onLegend();
    this.view.invalidate();
  }

  get waits(): boolean {
    return this.sentAt !== null;
  }

  private toggle(on: boolean): void {
    this.form.hidden = !on;
    this.button.setAttribute("aria-pressed", String(on));
    this.setDrawing(false);
    this.forget();
    if (on) {
      this.events.opened();
      this.takeLast();
    } else {
      this.events.tries(null);
    }
  }

  // The left button draws the pose; else it turns the map.
  private setDrawing(on: boolean): void {
    this.draw.setAttribute("aria-pressed", String(on));
    this.panel.classList.toggle("hinting", on);
    this.view.reserveLeftButton(on);
    this.pressed = false;
  }

  private takeLast(): void {
    const T = this.view.body.lastCamera();
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
    if (!this.panel.classList.contains("hinting") || event.button !== 0) return;
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

  private cameraPose(): THREE.Matrix4 {
    const place = new THREE.Vector3(this.value("x"), this.value("y"), this.value("z"));
    return cameraPose(place, this.value("yaw") / DEGREES, this.value("pitch") / DEGREES);
  }

  private bodyPose(): { position: THREE.Vector3; orientation: THREE.Quaternion } | null {
    const mount = mountOf(this.camera);
    if (!mount) return null;
    const T = this.cameraPose().multiply(mount.invert());
    const position = new THREE.Vector3();
    const orientation = new THREE.Quaternion();
    T.decompose(position, orientation, new THREE.Vector3());
    return { position, orientation };
  }

  private drawGhost(): void {
    const pose = this.bodyPose();
    if (pose) this.view.ghost.place(pose.position.toArray(), pose.orientation.toArray());
    if (this.camera) this.events.tries(seenFrom(this.cameraPose(), this.camera, this.view.cloud));
    this.view.invalidate();
  }

  private submit(): void {
    const pose = this.bodyPose();
    if (!pose) return;
    this.send({ order: "hint", position: pose.position.toArray(), orientation: pose.orientation.toArray() });
    this.toggle(false);
    this.sentAt = performance.now();
    this.view.ghost.object.visible = true;
    this.view.onLegend();
  }
}
