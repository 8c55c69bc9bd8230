import * as THREE from "three";
import { Lines } from "./lines";
import type { CameraInfo } from "./status";

const DEPTH_M = 0.35; // of the frustum drawn
const AXIS_M = 0.15;
export const AXES = [0xd55e00, 0x009e73, 0x2f8fd0]; // x, y, z

export function mountOf(camera: CameraInfo | null): THREE.Matrix4 | null {
  if (!camera?.position || !camera.orientation) return null;
  const one = new THREE.Vector3(1, 1, 1);
  return new THREE.Matrix4().compose(
    new THREE.Vector3(...camera.position),
    new THREE.Quaternion(...camera.orientation),
    one,
  );
}

// The camera's field of view in the camera frame: x right, y down, z forward. Eye, four corners, and a mark that says where up is.
function frustum(camera: CameraInfo | null) {
  const { width, height, fx, fy, cx, cy } = camera ?? { width: 640, height: 480, fx: 500, fy: 500, cx: 320, cy: 240 };
  const at = (u: number, v: number) => new THREE.Vector3(((u - cx) / fx) * DEPTH_M, ((v - cy) / fy) * DEPTH_M, DEPTH_M);
  const eye = new THREE.Vector3();
  const [a, b, c, d] = [at(0, 0), at(width, 0), at(width, height), at(0, height)];
  const up = at(width / 2, -0.25 * height);
  const lines = [eye, a, eye, b, eye, c, eye, d, a, b, b, c, c, d, d, a, at(0.35 * width, 0), up, up, at(0.65 * width, 0)];
  return { lines, faces: [eye, a, b, eye, b, c, eye, c, d, eye, d, a] };
}

export interface BodyStyle {
  axes?: boolean;
  filled?: boolean; // its field of view
  width: number; // of its lines, CSS pixels
}

// A body with its camera's field of view.
export class Body {
  readonly object = new THREE.Group();
  private readonly mount = new THREE.Group();
  private readonly lines: Lines;
  private readonly fill: THREE.Mesh<THREE.BufferGeometry, THREE.MeshBasicMaterial>;
  private drawn = "";

  constructor(style: BodyStyle) {
    this.lines = new Lines(10, style.width);
    const material = new THREE.MeshBasicMaterial({ transparent: true, opacity: 0.14, depthWrite: false, side: THREE.DoubleSide });
    this.fill = new THREE.Mesh(new THREE.BufferGeometry(), material);
    this.mount.matrixAutoUpdate = false;
    this.mount.add(this.lines.object);
    if (style.filled) this.mount.add(this.fill);
    this.object.add(this.mount);
    if (style.axes) {
      AXES.forEach((color, i) => {
        const axis = new Lines(1, 3);
        axis.setPairs([new THREE.Vector3(), new THREE.Vector3().setComponent(i, AXIS_M)]);
        axis.setColor(color);
        this.object.add(axis.object);
      });
    }
    this.object.traverse((part) => (part.frustumCulled = false));
    this.object.visible = false;
    this.setCamera(null);
  }

  setColor(css: string): void {
    this.lines.setColor(css);
    this.fill.material.color.set(css);
  }

  setOpacity(opacity: number): void {
    this.lines.setOpacity(opacity);
  }

  dispose(): void {
    this.lines.dispose();
    this.fill.geometry.dispose();
    this.fill.material.dispose();
  }

  setCamera(camera: CameraInfo | null): void {
    const text = JSON.stringify(camera);
    if (text === this.drawn) return;
    this.drawn = text;
    const { lines, faces } = frustum(camera);
    this.lines.setPairs(lines);
    this.fill.geometry.dispose();
    this.fill.geometry = new THREE.BufferGeometry().setFromPoints(faces);
    this.mount.matrix.copy(mountOf(camera) ?? new THREE.Matrix4());
    this.mount.matrixWorldNeedsUpdate = true;
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
