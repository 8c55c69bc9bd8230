import { color, element, isDark, onThemeChange, setText } from "./dom";
import type { Picture } from "./frames";

// From blue (on an edge) over grey to orange (far from any): told apart by all eyes.
const RESIDUAL_COLORS = Array.from({ length: 256 }, (_, value) => {
  const mix = (a: number[], b: number[], s: number) => a.map((x, i) => Math.round(x + s * (b[i]! - x)));
  const t = value / 255;
  const [r, g, b] = t < 0.5 ? mix([27, 156, 240], [143, 143, 168], 2 * t) : mix([143, 143, 168], [240, 140, 0], 2 * t - 1);
  return (255 << 24) | (b! << 16) | (g! << 8) | r!;
});

// The newest keyframe's time surface, with the map points as the estimate projects them.
export class SurfaceView {
  private readonly canvas = element<HTMLCanvasElement>("surface");
  private readonly context = this.canvas.getContext("2d")!;
  private gray = new Uint32Array(256);
  private image: ImageData | null = null;

  constructor() {
    this.paint();
    onThemeChange(() => this.paint());
  }

  show(picture: Picture): void {
    const { width, height, surface } = picture;
    if (this.image?.width !== width || this.image.height !== height) {
      this.canvas.width = width;
      this.canvas.height = height;
      this.image = this.context.createImageData(width, height);
    }
    const pixels = new Uint32Array(this.image.data.buffer);
    for (let i = 0; i < surface.length; ++i) pixels[i] = this.gray[surface[i]!]!;
    this.drawPoints(picture, pixels);
    this.context.putImageData(this.image, 0, 0);
    const n = picture.residuals.length;
    const onEdge = picture.residuals.reduce((sum, r) => sum + (r < 128 ? 1 : 0), 0);
    const share = n ? `, ${Math.round((100 * onEdge) / n)} % of ${n} points on edges` : ", no estimate";
    setText("surface-info", `decay ${(picture.decayUs / 1000).toFixed(1)} ms${share}`);
    setText("event-rate", picture.eventRate < 0 ? "–" : `${(picture.eventRate / 1e6).toFixed(2)} M/s`);
  }

  private drawPoints(picture: Picture, pixels: Uint32Array): void {
    const { width, height } = picture;
    for (let k = 0; k < picture.residuals.length; ++k) {
      const x = Math.round(picture.pixels[2 * k]! / 16);
      const y = Math.round(picture.pixels[2 * k + 1]! / 16);
      const residual = picture.residuals[k]!;
      // Most edges do not move across the image and have no events: their points are there, and small.
      const size = residual < 192 ? 4 : 2;
      if (x < 0 || y < 0 || x + size > width || y + size > height) continue;
      for (let row = y; row < y + size; ++row) {
        pixels.fill(RESIDUAL_COLORS[residual]!, row * width + x, row * width + x + size);
      }
    }
  }

  // 255: no event, the panel's background; 0: an event just now.
  private paint(): void {
    const far = parseInt(color("panel").slice(1), 16);
    const near = isDark() ? 0xd0d8e2 : 0x404854;
    this.gray = this.gray.map((_, value) => {
      const channel = (shift: number) => {
        const a = (near >> shift) & 255;
        return Math.round(a + (value / 255) * (((far >> shift) & 255) - a));
      };
      return ((255 << 24) | (channel(0) << 16) | (channel(8) << 8) | channel(16)) >>> 0;
    });
  }
}
