import * as THREE from "three";
import type { CameraInfo } from "./status";

const DEPTH_M = 0.35; // of the frustum drawn

export function mountOf(camera: CameraInfo | null): THREE.Matrix4 | null {
  if (!camera?.position || !camera.orientation) return null;
  const one = new THREE.Vector3(1, 1, 1);
  return new THREE.Matrix4().compose(
    new THREE.Vector3(...camera.position),
    new THREE.Quaternion(...camera.orientation),
    one,
  );
}

// The camera's field of view as lines, in the camera frame: x right, y down, z forward.
export function frustumLines(camera: CameraInfo | null): THREE.BufferGeometry {
  const { width, height, fx, fy, cx, cy } = camera ?? { width: 640, height: 480, fx: 500, fy: 500, cx: 320, cy: 240 };
  const corner = (u: number, v: number) =>
    new THREE.Vector3(((u - cx) / fx) * DEPTH_M, ((v - cy) / fy) * DEPTH_M, DEPTH_M);
  const [a, b, c, d] = [corner(0, 0), corner(width, 0), corner(width, height), corner(0, height)];
  const eye = new THREE.Vector3();
  const up = corner(width / 2, -0.25 * height);
  const lines = [eye, a, eye, b, eye, c, eye, d, a, b, b, c, c, d, d, a, corner(0.35 * width, 0), up, up, corner(0.65 * width, 0)];
  return new THREE.BufferGeometry().setFromPoints(lines);
}

// A body with its axes and its camera.
export class Body {
  readonly object = new THREE.Group();
  private readonly frustum: THREE.LineSegments<THREE.BufferGeometry, THREE.LineBasicMaterial>;
  private drawn = "";

  constructor(axes: boolean) {
    this.frustum = new THREE.LineSegments(frustumLines(null), new THREE.LineBasicMaterial());
    this.frustum.matrixAutoUpdate = false;
    this.object.add(this.frustum);
    if (axes) {
      const helper = new THREE.AxesHelper(0.15);
      helper.setColors(new THREE.Color(0xd55e00), new THREE.Color(0x009e73), new THREE.Color(0x0072b2));
      this.object.add(helper);
    }
    this.object.traverse((part) => (part.frustumCulled = false));
    this.object.visible = false;
  }

  setColor(css: string): void {
    this.frustum.material.color.set(css);
  }

  setOpacity(opacity: number): void {
    this.frustum.material.opacity = opacity;
    this.frustum.material.transparent = opacity < 1;
  }

  dispose(): void {
    this.frustum.geometry.dispose();
    this.frustum.material.dispose();
  }

  setCamera(camera: CameraInfo | null): void {
    const text = JSON.stringify(camera);
    if (text === this.drawn) return;
    this.drawn = text;
    this.frustum.geometry.dispose();
    this.frustum.geometry = frustumLines(camera);
    this.frustum.matrix.copy(mountOf(camera) ?? new THREE.Matrix4());
    this.frustum.matrixWorldNeedsUpdate = true;
  }

  place(position: number[], orientation: number[]): void {
    this.object.position.fromArray(position);
    this.object.quaternion.fromArray(orientation);
    this.object.visible = true;
  }
}

// Maps the unit sphere onto the ellipsoid of `sigmas` standard deviations: the Cholesky factor of the
// covariance's upper left 3x3 of 6x6, m.
export function ellipsoidMatrix(covariance: Float32Array, position: number[], sigmas: number): THREE.Matrix4 {
  const c = (i: number, j: number) => covariance[6 * i + j] ?? 0;
  const root = (x: number) => Math.sqrt(Math.max(x, 1e-12));
  const a = root(c(0, 0));
  const b = c(1, 0) / a;
  const d = c(2, 0) / a;
  const e = root(c(1, 1) - b * b);
  const f = (c(2, 1) - d * b) / e;
  const g = root(c(2, 2) - d * d - f * f);
  const s = sigmas;
  const [x, y, z] = position as [number, number, number];
  return new THREE.Matrix4().set(s * a, 0, 0, x, s * b, s * e, 0, y, s * d, s * f, s * g, z, 0, 0, 0, 1);
}
