import { color, element, isDark, onThemeChange, setText } from "./dom";
import type { Picture } from "./frames";

const EVENT = 240; // surface values below: an event in the last three decay times
const REACH = 2; // pixels in which a point's events are looked for, as evit map check does: a map errs by that
const CHANCE_STEP = 8; // pixels between those that tell what chance gives

// Pixels within REACH.
const AROUND = Array.from({ length: (2 * REACH + 1) ** 2 }, (_, i) => [(i % (2 * REACH + 1)) - REACH, Math.floor(i / (2 * REACH + 1)) - REACH] as const)
  .filter(([dx, dy]) => dx * dx + dy * dy <= REACH * REACH);

// Blue, paler for older events near, and tan without any: told apart by all eyes, and none of them an alarm.
const RESIDUAL_COLORS = Array.from({ length: 256 }, (_, value) => {
  const mix = (a: number[], b: number[], s: number) => a.map((x, i) => Math.round(x + s * (b[i]! - x)));
  const [r, g, b] = value < EVENT ? mix([0, 90, 220], [110, 165, 225], value / EVENT) : [205, 170, 120];
  return (255 << 24) | (b! << 16) | (g! << 8) | r!;
});

// The newest surface value within REACH of a pixel.
function nearest({ surface, width, height }: Picture, x: number, y: number): number {
  let least = 255;
  for (const [dx, dy] of AROUND) {
    const [column, row] = [x + dx, y + dy];
    if (column < 0 || row < 0 || column >= width || row >= height) continue;
    const value = surface[row * width + column]!;
    if (value < least) least = value;
  }
  return least;
}

// Share of an even sample of all pixels that have events near them: what points get by chance.
function chanceOf(picture: Picture): number {
  let [n, near] = [0, 0];
  for (let y = CHANCE_STEP / 2; y < picture.height; y += CHANCE_STEP) {
    for (let x = CHANCE_STEP / 2; x < picture.width; x += CHANCE_STEP) {
      n += 1;
      if (nearest(picture, x, y) < EVENT) near += 1;
    }
  }
  return n ? near / n : 0;
}

// The newest keyframe's time surface, with the map points as the estimate projects them.
export class SurfaceView {
  private readonly canvas = element<HTMLCanvasElement>("surface");
  private readonly context = this.canvas.getContext("2d")!;
  private gray = new Uint32Array(256);
  private image: ImageData | null = null;
  private waiting: Picture[] = [];
  private shown: Picture | null = null;
  private tried: Float32Array | null = null; // pixels, x y x y ...: the map as a pose that is about to be given sees it
  near: number | null = null; // share of the newest estimate's points that have events near them; null: not known

  // `drawn`: a picture is on the screen. Called for each, also for those a newer one has overtaken.
  constructor(private readonly drawn: (picture: Picture) => void) {
    this.paint();
    onThemeChange(() => {
      this.paint();
      if (this.shown) this.draw(this.shown);
    });
    this.explain("no keyframe yet: frame_builder sends one as soon as events and IMU samples come");
  }

  // The map's points from a pose that is about to be given, instead of the estimate's; null: the estimate's.
  tryPoints(pixels: Float32Array | null): void {
    if (!pixels && !this.tried) return;
    this.tried = pixels;
    if (this.shown) this.draw(this.shown);
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
    for (let i = 0; i < surface.length; ++i) pixels[i] = this.gray[surface[i]!]!;
    const points = this.pointsOn(picture);
    this.drawPoints(picture, points, pixels);
    this.context.putImageData(this.image, 0, 0);
    this.shown = picture;
    setText("surface-empty", "");
    this.tell(picture, points);
  }

  // x, y and the newest surface value near, of each point.
  private pointsOn(picture: Picture): [number, number, number][] {
    const scale = this.tried ? 1 : 1 / 16;
    const from = this.tried ?? picture.pixels;
    return Array.from({ length: from.length / 2 }, (_, k) => {
      const [x, y] = [Math.round(from[2 * k]! * scale), Math.round(from[2 * k + 1]! * scale)];
      return [x, y, nearest(picture, x, y)];
    });
  }

  private tell(picture: Picture, points: [number, number, number][]): void {
    const n = points.length;
    const share = points.reduce((sum, [, , value]) => sum + (value < EVENT ? 1 : 0), 0) / Math.max(1, n);
    const chance = chanceOf(picture);
    if (!this.tried && n) this.near = share;
    const percent = (x: number) => `${Math.round(100 * x)} %`;
    setText("event-rate", picture.eventRate < 0 ? "–" : `${(picture.eventRate / 1e6).toFixed(2)} M/s`);
    setText("decay", `${(picture.decayUs / 1000).toFixed(1)} ms`);
    setText("on-edges", n ? `${percent(share)}, ${percent(chance)} by chance` : "no estimate");
    setText("contrast", n && chance > 0 ? `${(share / chance).toFixed(1)} ×` : "–");
  }

  private drawPoints({ width, height }: Picture, points: [number, number, number][], pixels: Uint32Array): void {
    // Most edges do not move across the image and have no events: their points are small, and below the others.
    for (const near of [false, true]) {
      for (const [column, row, value] of points) {
        if (value < EVENT !== near) continue;
        const size = near ? 4 : 2;
        const [x, y] = [column - size / 2, row - size / 2];
        if (x < 0 || y < 0 || x + size > width || y + size > height) continue;
        for (let line = y; line < y + size; ++line) {
          pixels.fill(RESIDUAL_COLORS[value]!, line * width + x, line * width + x + size);
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
