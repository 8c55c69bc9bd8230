import * as THREE from "three";
import { color } from "./dom";

// The floor, in steps of 1, 2 or 5 times a power of ten metres.
export class FloorGrid {
  readonly object = new THREE.Group();
  private grid: THREE.GridHelper | null = null;
  private stepM = 0;

  // Metres between two lines; 0 before there is a floor.
  get step(): number {
    return this.stepM;
  }

  // Under a map of this size around its center, at height z; metres.
  lay(center: THREE.Vector3, radius: number, z: number): void {
    if (this.grid) this.object.remove(this.grid);
    this.grid?.dispose();
    const rough = radius / 3;
    const power = 10 ** Math.floor(Math.log10(rough));
    this.stepM = power * ([5, 2, 1].find((k) => k * power <= rough) ?? 1);
    const n = 2 * Math.ceil(radius / this.stepM);
    this.grid = new THREE.GridHelper(n * this.stepM, n);
    this.grid.rotateX(Math.PI / 2);
    this.grid.position.set(this.stepM * Math.round(center.x / this.stepM), this.stepM * Math.round(center.y / this.stepM), z);
    this.grid.renderOrder = -1;
    this.paint();
    this.object.add(this.grid);
  }

  // In the colour of the page's theme.
  paint(): void {
    if (!this.grid) return;
    const material = this.grid.material as THREE.LineBasicMaterial;
    material.vertexColors = false;
    material.color.set(color("grid"));
    material.needsUpdate = true;
    material.depthWrite = false;
  }
}
