import * as THREE from "three";
import { Body, ellipsoidMatrix, mountOf } from "./body";
import { color } from "./dom";
import type { Pose, WindowState } from "./frames";
import type { CameraInfo } from "./status";
import { Trail } from "./trail";

// The tracked body: where it is or was last, its path, and the ellipsoid of what is known of its position.
export class TrackedBody {
  readonly object = new THREE.Group();
  private readonly body = new Body({ width: 2.5, axes: true, filled: true });
  private readonly trail = new Trail(2);
  private readonly ellipsoid: THREE.Mesh<THREE.SphereGeometry, THREE.MeshBasicMaterial>;
  private placed = false;
  private known = true;
  private hidden = false; // seen through its own camera
  private camera: CameraInfo | null = null;

  constructor() {
    const material = new THREE.MeshBasicMaterial({ transparent: true, opacity: 0.4, depthWrite: false });
    this.ellipsoid = new THREE.Mesh(new THREE.SphereGeometry(1, 24, 16), material);
    this.ellipsoid.matrixAutoUpdate = false;
    this.ellipsoid.visible = false;
    this.object.add(this.trail.object, this.body.object, this.ellipsoid);
  }

  get hasPose(): boolean {
    return this.placed;
  }

  // Whether the newest pose holds; else it is where the body was last.
  get isKnown(): boolean {
    return this.known;
  }

  get position(): THREE.Vector3 {
    return this.body.object.position;
  }

  setCamera(camera: CameraInfo | null): void {
    this.camera = camera;
    this.body.setCamera(camera);
  }

  setPose(pose: Pose): void {
    this.body.place(pose.position, pose.orientation);
    this.body.object.visible = !this.hidden;
    this.placed = true;
    this.trail.add(pose);
  }

  // Where the body was; setPose says where it is.
  addPast(pose: Pose): void {
    this.trail.add(pose);
  }

  // The covariance, drawn at so many standard deviations.
  setWindow(state: WindowState, sigmas: number): void {
    this.ellipsoid.matrix.copy(ellipsoidMatrix(state.covariance, state.position, sigmas));
    this.ellipsoid.visible = this.known && !this.hidden;
  }

  setKnown(yes: boolean): void {
    this.known = yes;
    if (!yes) this.ellipsoid.visible = false;
    this.paint();
  }

  // The body's own camera does not see the body.
  setHidden(yes: boolean): void {
    this.hidden = yes;
    this.body.object.visible = this.placed && !yes;
    if (yes) this.ellipsoid.visible = false;
  }

  forget(): void {
    this.placed = this.body.object.visible = this.ellipsoid.visible = false;
    this.clearTrail();
  }

  clearTrail(): void {
    this.trail.clear();
  }

  // T_map_camera of the newest pose; null where there is none.
  lastCamera(): THREE.Matrix4 | null {
    const mount = mountOf(this.camera);
    if (!mount || !this.placed) return null;
    this.body.object.updateMatrix();
    return this.body.object.matrix.clone().multiply(mount);
  }

  // In the colours of the page's theme.
  paint(): void {
    this.trail.setColor(color("accent"));
    this.body.setColor(color(this.known ? "accent" : "soft"));
    this.body.setOpacity(this.known ? 1 : 0.5);
    this.ellipsoid.material.color.set(color("accent"));
  }
}
