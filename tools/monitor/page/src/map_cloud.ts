import * as THREE from "three";
import type { MapPiece } from "./frames";

const VERTEX = `
attribute vec3 position; uniform mat4 modelViewMatrix, projectionMatrix; uniform vec2 range; uniform float size;
varying float height;
void main() {
  height = clamp((position.z - range.x) / (range.y - range.x), 0.0, 1.0);
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  gl_PointSize = clamp(size / gl_Position.w, 1.0, 3.0);
}`;
// Height from low to high: lightness grows steadily, as in cividis.
const FRAGMENT = `
precision mediump float; uniform vec3 low, middle, high; varying float height;
void main() {
  gl_FragColor = vec4(height < 0.5 ? mix(low, middle, 2.0 * height) : mix(middle, high, 2.0 * height - 1.0), 1.0);
}`;

// The map's points in one buffer that grows as they come.
export class MapCloud {
  readonly object: THREE.Points<THREE.BufferGeometry, THREE.RawShaderMaterial>;
  readonly box = new THREE.Box3();
  count = 0;
  private generation = 0;
  private xyz = new Float32Array(3 * 65536);
  private heights: number[] = []; // a sample, for the range of colours

  constructor() {
    const uniform = (hex: number) => ({ value: new THREE.Color(hex) });
    const material = new THREE.RawShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      uniforms: {
        range: { value: new THREE.Vector2(0, 1) },
        size: { value: 14 },
        low: uniform(0),
        middle: uniform(0),
        high: uniform(0),
      },
    });
    this.object = new THREE.Points(new THREE.BufferGeometry(), material);
    this.object.frustumCulled = false;
    this.attach();
  }

  setColors(dark: boolean): void {
    const { low, middle, high } = this.object.material.uniforms;
    const set = (to: THREE.IUniform | undefined, hex: number) => (to!.value as THREE.Color).setHex(hex, THREE.LinearSRGBColorSpace);
    set(low, dark ? 0x3f5f8f : 0x00224e);
    set(middle, dark ? 0x9a9a92 : 0x66696f);
    set(high, dark ? 0xf5df6a : 0xb39a2f);
  }

  add(piece: MapPiece): void {
    if (piece.generation !== this.generation) {
      this.generation = piece.generation;
      this.count = 0;
      this.heights = [];
      this.box.makeEmpty();
    }
    const end = piece.first + piece.xyz.length / 3;
    if (3 * end > this.xyz.length) {
      const larger = new Float32Array(Math.max(3 * end, 2 * this.xyz.length));
      larger.set(this.xyz);
      this.xyz = larger;
      this.attach();
    }
    this.xyz.set(piece.xyz, 3 * piece.first);
    const attribute = this.object.geometry.getAttribute("position") as THREE.BufferAttribute;
    attribute.addUpdateRange(3 * piece.first, piece.xyz.length);
    attribute.needsUpdate = true;
    this.count = end;
    this.object.geometry.setDrawRange(0, end);
    this.measure(piece.xyz);
  }

  private attach(): void {
    this.object.geometry.dispose();
    const geometry = new THREE.BufferGeometry();
    const attribute = new THREE.BufferAttribute(this.xyz, 3);
    attribute.setUsage(THREE.DynamicDrawUsage);
    geometry.setAttribute("position", attribute);
    geometry.setDrawRange(0, this.count);
    this.object.geometry = geometry;
  }

  private measure(xyz: Float32Array): void {
    const point = new THREE.Vector3();
    for (let i = 0; i + 2 < xyz.length; i += 3) this.box.expandByPoint(point.fromArray(xyz, i));
    const step = 3 * Math.max(1, Math.floor(xyz.length / 3 / 500));
    for (let i = 2; i < xyz.length && this.heights.length < 20000; i += step) this.heights.push(xyz[i]!);
    const sorted = [...this.heights].sort((a, b) => a - b);
    const at = (share: number) => sorted[Math.floor(share * (sorted.length - 1))] ?? 0;
    const low = at(0.02);
    (this.object.material.uniforms.range!.value as THREE.Vector2).set(low, Math.max(at(0.98), low + 0.1));
  }
}
