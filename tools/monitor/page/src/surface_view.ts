import { color, element, isDark, onThemeChange, setText } from "./dom";
import type { Picture } from "./frames";

const EDGE = 128; // surface values below are on an edge

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
  private waiting: Picture[] = [];
  private shown: Picture | null = null;

  // `drawn`: a picture is on the screen. Called for each, also for those a newer one has overtaken.
  constructor(private readonly drawn: (picture: Picture) => void) {
    this.paint();
    onThemeChange(() => {
      this.paint();
      if (this.shown) this.draw(this.shown);
    });
    this.explain("no keyframe yet: frame_builder sends one as soon as events and IMU samples come");
  }

  // Nothing to see: why.
  explain(why: string): void {
    setText("surface-empty", this.shown ? "" : why);
  }

  show(picture: Picture): void {
    this.waiting.push(picture);
    if (this.waiting.length > 1) return;
    // A hidden page draws nothing: the server need not send more than one a second.
    if (document.hidden) setTimeout(() => this.flush(), 1000);
    else requestAnimationFrame(() => this.flush());
  }

  private flush(): void {
    const pictures = this.waiting.splice(0);
    const newest = pictures.at(-1);
    if (!newest) return;
    this.draw(newest);
    // Behind the frame that paints it.
    setTimeout(() => pictures.forEach((picture) => this.drawn(picture)));
  }

  private draw(picture: Picture): void {
    const { width, height, surface } = picture;
    if (this.image?.width !== width || this.image.height !== height) {
      this.canvas.width = width;
      this.canvas.height = height;
      this.image = this.context.createImageData(width, height);
    }
    const pixels = new Uint32Array(this.image.data.buffer);
    let edges = 0;
    for (let i = 0; i < surface.length; ++i) {
      const value = surface[i]!;
      pixels[i] = this.gray[value]!;
      if (value < EDGE) ++edges;
    }
    this.drawPoints(picture, pixels);
    this.context.putImageData(this.image, 0, 0);
    this.shown = picture;
    setText("surface-empty", "");
    this.tell(picture, edges / surface.length);
  }

  private tell(picture: Picture, edgeShare: number): void {
    const n = picture.residuals.length;
    const share = picture.residuals.reduce((sum, r) => sum + (r < EDGE ? 1 : 0), 0) / Math.max(1, n);
    setText("event-rate", picture.eventRate < 0 ? "–" : `${(picture.eventRate / 1e6).toFixed(2)} M/s`);
    setText("decay", `${(picture.decayUs / 1000).toFixed(1)} ms`);
    setText("on-edges", n ? `${Math.round(100 * share)} % of ${n.toLocaleString("en")}` : "no estimate");
    setText("contrast", n && edgeShare > 0 ? `${(share / edgeShare).toFixed(1)} ×` : "–");
  }

  private drawPoints(picture: Picture, pixels: Uint32Array): void {
    const { width, height } = picture;
    // Most edges do not move across the image and have no events: their points are small, and below the others.
    for (const onEdge of [false, true]) {
      for (let k = 0; k < picture.residuals.length; ++k) {
        const residual = picture.residuals[k]!;
        const size = residual < 192 ? 4 : 2;
        if (residual < EDGE !== onEdge) continue;
        const x = Math.round(picture.pixels[2 * k]! / 16 - size / 2);
        const y = Math.round(picture.pixels[2 * k + 1]! / 16 - size / 2);
        if (x < 0 || y < 0 || x + size > width || y + size > height) continue;
        for (let row = y; row < y + size; ++row) {
          pixels.fill(RESIDUAL_COLORS[residual]!, row * width + x, row * width + x + size);
        }
      }
    }
  }

  // 255: no event, the panel's background; 0: an event just now.
  private paint(): void {
    const far = parseInt(color("panel").slice(1), 16);
    const near = isDark() ? 0xd0d8e2 : 0x303844;
    this.gray = this.gray.map((_, value) => {
      const channel = (shift: number) => {
        const a = (near >> shift) & 255;
        return Math.round(a + (value / 255) * (((far >> shift) & 255) - a));
      };
      return ((255 << 24) | (channel(0) << 16) | (channel(8) << 8) | channel(16)) >>> 0;
    });
  }
}
