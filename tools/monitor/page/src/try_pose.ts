import * as THREE from "three";
import type { MapCloud } from "./map_cloud";
import type { CameraInfo } from "./status";

const MOST = 60_000; // points that are projected
const CELL = 6; // pixels: a nearer point hides those behind it here
const BEHIND = 1.1; // times as far as the nearest: hidden
const NEAREST_M = 0.05;

// The map's points as a camera at `T_map_camera` sees them (without distortion), pixels x y x y ...
export function seenFrom(T_map_camera: THREE.Matrix4, camera: CameraInfo, cloud: MapCloud): Float32Array {
  const T = T_map_camera.clone().invert();
  const columns = Math.ceil(camera.width / CELL);
  const nearest = new Float32Array(columns * Math.ceil(camera.height / CELL)).fill(Infinity);
  const seen: number[] = []; // x, y, depth, cell
  const point = new THREE.Vector3();
  const step = Math.max(1, Math.ceil(cloud.count / MOST));
  for (let i = 0; i < cloud.count; i += step) {
    cloud.point(i, point).applyMatrix4(T);
    if (point.z < NEAREST_M) continue;
    const x = (camera.fx * point.x) / point.z + camera.cx;
    const y = (camera.fy * point.y) / point.z + camera.cy;
    if (x < 0 || y < 0 || x >= camera.width || y >= camera.height) continue;
    const at = Math.floor(y / CELL) * columns + Math.floor(x / CELL);
    if (point.z < nearest[at]!) nearest[at] = point.z;
    seen.push(x, y, point.z, at);
  }
  const pixels: number[] = [];
  for (let k = 0; k < seen.length; k += 4) {
    if (seen[k + 2]! <= BEHIND * nearest[seen[k + 3]!]!) pixels.push(seen[k]!, seen[k + 1]!);
  }
  return new Float32Array(pixels);
}
