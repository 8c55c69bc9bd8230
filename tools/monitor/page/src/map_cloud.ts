import * as THREE from "three";
import type { MapPiece } from "./frames";

const VERTEX = `
attribute vec3 position; uniform mat4 modelViewMatrix, projectionMatrix; uniform vec2 range; uniform float size, least;
varying float height;
void main() {
  height = clamp((position.z - range.x) / (range.y - range.x), 0.0, 1.0);
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  gl_PointSize = clamp(size / gl_Position.w, least, 2.5 * least);
}`;
// Height from low to high: lightness grows steadily, as in cividis.
const FRAGMENT = `
precision mediump float; uniform vec3 low, middle, high; varying float height;
void main() {
  gl_FragColor = vec4(height < 0.5 ? mix(low, middle, 2.0 * height) : mix(middle, high, 2.0 * height - 1.0), 1.0);
}`;
const COLORS = { light: [0x00224e, 0x66696f, 0xb39a2f], dark: [0x4a6ea8, 0x9a9a92, 0xf5df6a] };
const SAMPLE = 4000; // points, of which extent and colours are computed

// The map's points in one buffer, drawn with one call. A map from a file comes in random order: its first points are an
// even sample, and all that is drawn where the graphics are slow.
export class MapCloud {
  readonly object: THREE.Points<THREE.BufferGeometry, THREE.RawShaderMaterial>;
  readonly box = new THREE.Box3(); // without strays
  readonly heights = new THREE.Vector2(); // m: of the lowest and the highest colour
  count = 0;
  private generation = 0;
  private xyz = new Float32Array(0);
  private sampled = 0; // points when box and heights were computed

  constructor() {
    const uniform = () => ({ value: new THREE.Color() });
    const material = new THREE.RawShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      uniforms: { range: { value: this.heights }, size: { value: 7 }, least: { value: 1 }, low: uniform(), middle: uniform(), high: uniform() },
    });
    this.object = new THREE.Points(new THREE.BufferGeometry(), material);
    this.object.frustumCulled = false;
    this.attach();
  }

  // CSS colours of the ramp, low to high.
  setTheme(dark: boolean): string {
    const colors = dark ? COLORS.dark : COLORS.light;
    const uniforms = this.object.material.uniforms;
    ["low", "middle", "high"].forEach((name, i) => (uniforms[name]!.value as THREE.Color).setHex(colors[i]!, THREE.LinearSRGBColorSpace));
    return colors.map((hex) => `#${hex.toString(16).padStart(6, "0")}`).join(", ");
  }

  setPixelRatio(ratio: number): void {
    this.object.material.uniforms.size!.value = 7 * ratio;
    this.object.material.uniforms.least!.value = ratio;
  }

  // Draws this share of the points, at least `least` of them.
  setShare(share: number, least: number): void {
    this.object.geometry.setDrawRange(0, Math.min(this.count, Math.max(least, Math.ceil(share * this.count))));
  }

  get drawn(): number {
    return Math.min(this.count, this.object.geometry.drawRange.count);
  }

  point(i: number, to: THREE.Vector3): THREE.Vector3 {
    return to.fromArray(this.xyz, 3 * i);
  }

  add(piece: MapPiece): void {
    if (piece.generation !== this.generation) {
      this.generation = piece.generation;
      this.count = this.sampled = 0;
      this.box.makeEmpty();
    }
    const end = piece.first + piece.xyz.length / 3;
    const room = Math.max(end, piece.capacity);
    if (3 * room > this.xyz.length) {
      const larger = new Float32Array(3 * room);
      larger.set(this.xyz.subarray(0, 3 * this.count));
      this.xyz = larger;
      this.attach();
    }
    this.xyz.set(piece.xyz, 3 * piece.first);
    const attribute = this.object.geometry.getAttribute("position") as THREE.BufferAttribute;
    attribute.addUpdateRange(3 * piece.first, piece.xyz.length);
    attribute.needsUpdate = true;
    this.count = end;
    this.object.geometry.setDrawRange(0, end);
    if (this.count > 1.2 * this.sampled) this.measure();
  }

  private attach(): void {
    this.object.geometry.dispose();
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(this.xyz, 3));
    geometry.setDrawRange(0, this.count);
    this.object.geometry = geometry;
  }

  private measure(): void {
    this.sampled = this.count;
    const step = 3 * Math.max(1, Math.floor(this.count / SAMPLE));
    const along = [0, 1, 2].map((axis) => {
      const values: number[] = [];
      for (let i = axis; i < 3 * this.count; i += step) values.push(this.xyz[i]!);
      return values.sort((a, b) => a - b);
    });
    const at = (axis: number, share: number) => along[axis]![Math.floor(share * (along[axis]!.length - 1))] ?? 0;
    this.box.min.set(at(0, 0.005), at(1, 0.005), at(2, 0.005));
    this.box.max.set(at(0, 0.995), at(1, 0.995), at(2, 0.995));
    const low = at(2, 0.02);
    this.heights.set(low, Math.max(at(2, 0.98), low + 0.1));
  }
}
