import * as THREE from "three";
import type { Pose } from "./frames";

const MOST = 20000; // pieces of the path
const LONGEST_M = 0.5;
const LONGEST_US = 500_000;

// The path so far, as pieces between successive poses; a jump leaves a gap.
export class Trail {
  readonly object: THREE.LineSegments<THREE.BufferGeometry, THREE.LineBasicMaterial>;
  private readonly attribute = new THREE.BufferAttribute(new Float32Array(6 * MOST), 3);
  private n = 0;
  private last: Pose | null = null;

  constructor() {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", this.attribute);
    geometry.setDrawRange(0, 0);
    this.object = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial());
    this.object.frustumCulled = false;
  }

  clear(): void {
    this.n = 0;
    this.last = null;
    this.object.geometry.setDrawRange(0, 0);
  }

  add(pose: Pose): void {
    const before = this.last;
    this.last = pose;
    if (!before) return;
    const distance = Math.hypot(...pose.position.map((x, i) => x - before.position[i]!));
    const time = pose.utime - before.utime;
    if (distance > LONGEST_M || time <= 0 || time > LONGEST_US) return;
    const at = this.n % MOST; // the oldest gives way
    this.attribute.array.set([...before.position, ...pose.position], 6 * at);
    this.attribute.addUpdateRange(6 * at, 6);
    this.attribute.needsUpdate = true;
    this.n += 1;
    this.object.geometry.setDrawRange(0, 2 * Math.min(this.n, MOST));
  }
}
