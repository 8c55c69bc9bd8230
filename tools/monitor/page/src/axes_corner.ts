import * as THREE from "three";
import { AXES } from "./body";
import { element } from "./dom";

const SIZE = 74; // CSS pixels
const LENGTH = 24;

// Where the map's x, y and z point, in a corner of the view.
export class AxesCorner {
  private readonly context: CanvasRenderingContext2D;

  constructor() {
    const canvas = element<HTMLCanvasElement>("map-axes");
    canvas.width = canvas.height = SIZE * devicePixelRatio;
    this.context = canvas.getContext("2d")!;
    this.context.scale(devicePixelRatio, devicePixelRatio);
    Object.assign(this.context, { font: "bold 12px system-ui, sans-serif", textAlign: "center", textBaseline: "middle", lineWidth: 2.5 });
  }

  draw(camera: THREE.Camera): void {
    const { context } = this;
    const turn = camera.quaternion.clone().invert();
    const middle = SIZE / 2;
    context.clearRect(0, 0, SIZE, SIZE);
    const axes = AXES.map((hex, i) => ({ hex, name: "xyz"[i]!, to: new THREE.Vector3().setComponent(i, 1).applyQuaternion(turn) }));
    // What points at the viewer lies over what points away.
    for (const { hex, name, to } of axes.sort((a, b) => a.to.z - b.to.z)) {
      context.strokeStyle = context.fillStyle = `#${hex.toString(16).padStart(6, "0")}`;
      context.beginPath();
      context.moveTo(middle, middle);
      context.lineTo(middle + LENGTH * to.x, middle - LENGTH * to.y);
      context.stroke();
      context.fillText(name, middle + 1.35 * LENGTH * to.x, middle - 1.35 * LENGTH * to.y);
    }
  }
}
