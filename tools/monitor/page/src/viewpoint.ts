import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import type { CameraInfo } from "./status";

export type View = "orbit" | "follow" | "camera";

// From three's camera (looks along -z, y up) to ours (looks along z, y down).
const TURN = new THREE.Quaternion(1, 0, 0, 0);
const FOV = 50; // degrees

// From where the map is looked at: around a point that the user moves, after the body, or through its camera.
export class Viewpoint {
  readonly camera = new THREE.PerspectiveCamera(FOV, 1, 0.02, 1000);
  private readonly controls: OrbitControls;
  private readonly outside = new THREE.Vector3(); // where it was looked from before the camera's view
  private current: View = "orbit";
  private moved = false;

  // onChange: the user turns, moves or zooms.
  constructor(private readonly canvas: HTMLCanvasElement, onChange: () => void) {
    this.camera.up.set(0, 0, 1);
    this.camera.position.set(-3, -4, 3);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", onChange);
    this.controls.addEventListener("start", () => (this.moved = true));
  }

  get view(): View {
    return this.current;
  }

  // By the user: no more framing.
  get touched(): boolean {
    return this.moved;
  }

  // body: its position, for "follow".
  setView(view: View, body: THREE.Vector3): void {
    if (view === "camera") this.outside.copy(this.camera.position);
    else if (this.current === "camera") this.camera.position.copy(this.outside);
    this.current = view;
    this.controls.enabled = view !== "camera";
    this.camera.fov = FOV;
    this.camera.updateProjectionMatrix();
    if (view === "follow") this.approach(body);
    if (view !== "camera") this.controls.update();
  }

  // The left button is for something else; turning is not possible, moving and zooming are.
  reserveLeftButton(yes: boolean): void {
    this.controls.mouseButtons.LEFT = yes ? null : THREE.MOUSE.ROTATE;
  }

  setAspect(aspect: number): void {
    this.camera.aspect = aspect;
    this.camera.updateProjectionMatrix();
  }

  // The body went from one place to another, and so does who follows it.
  follow(from: THREE.Vector3, to: THREE.Vector3): void {
    this.camera.position.add(to).sub(from);
    this.controls.target.copy(to);
    this.controls.update();
  }

  lookThrough(T_map_camera: THREE.Matrix4, info: CameraInfo): void {
    T_map_camera.decompose(this.camera.position, this.camera.quaternion, new THREE.Vector3());
    this.camera.quaternion.multiply(TURN);
    this.camera.fov = (2 * Math.atan(info.height / 2 / info.fy) * 180) / Math.PI;
    this.camera.updateProjectionMatrix();
  }

  // A ball of this radius in view, from above and one side.
  frame(center: THREE.Vector3, radius: number): void {
    const narrow = Math.min(1, this.camera.aspect);
    const distance = (0.78 * radius) / Math.sin((FOV * Math.PI) / 360) / narrow;
    this.controls.target.copy(center);
    this.camera.position.copy(center).add(new THREE.Vector3(-0.52, -0.68, 0.52).normalize().multiplyScalar(distance));
    this.controls.update();
  }

  // The ray through a point of the canvas, CSS pixels.
  ray(x: number, y: number): THREE.Ray {
    const box = this.canvas.getBoundingClientRect();
    const at = new THREE.Vector2((2 * (x - box.left)) / box.width - 1, 1 - (2 * (y - box.top)) / box.height);
    const caster = new THREE.Raycaster();
    caster.setFromCamera(at, this.camera);
    return caster.ray;
  }

  // The body in the middle, from where it is looked at now but not from farther away than some metres.
  private approach(body: THREE.Vector3): void {
    const from = this.camera.position.clone().sub(this.controls.target).clampLength(0.3, 2.5);
    this.controls.target.copy(body);
    this.camera.position.copy(body).add(from);
  }
}
