import * as THREE from "three";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";

// Straight pieces, some pixels wide (lines of WebGL itself are one pixel thin), in one draw call.
export class Lines {
  readonly object: LineSegments2;
  private readonly buffer: THREE.InstancedInterleavedBuffer;

  // `most`: pieces there is room for; `width`: CSS pixels.
  constructor(most: number, width: number) {
    const geometry = new LineSegmentsGeometry();
    geometry.setPositions(new Float32Array(6 * most));
    this.buffer = (geometry.getAttribute("instanceStart") as THREE.InterleavedBufferAttribute).data as THREE.InstancedInterleavedBuffer;
    this.buffer.setUsage(THREE.DynamicDrawUsage);
    geometry.instanceCount = 0;
    this.object = new LineSegments2(geometry, new LineMaterial({ linewidth: width, transparent: true }));
    this.object.frustumCulled = false;
  }

  // Piece `i` from a to b.
  set(i: number, a: ArrayLike<number>, b: ArrayLike<number>): void {
    for (let k = 0; k < 3; ++k) {
      this.buffer.array[6 * i + k] = a[k]!;
      this.buffer.array[6 * i + 3 + k] = b[k]!;
    }
    this.buffer.addUpdateRange(6 * i, 6);
    this.buffer.needsUpdate = true;
  }

  setCount(n: number): void {
    this.object.geometry.instanceCount = n;
    this.object.visible = n > 0;
  }

  setPairs(points: THREE.Vector3[]): void {
    for (let i = 0; 2 * i + 1 < points.length; ++i) this.set(i, points[2 * i]!.toArray(), points[2 * i + 1]!.toArray());
    this.setCount(points.length / 2);
  }

  setColor(css: THREE.ColorRepresentation): void {
    this.object.material.color.set(css);
  }

  setOpacity(opacity: number): void {
    this.object.material.opacity = opacity;
  }

  dispose(): void {
    this.object.geometry.dispose();
    this.object.material.dispose();
  }
}
