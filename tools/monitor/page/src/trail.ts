import type { Pose } from "./frames";
import { Lines } from "./lines";

const MOST = 20000; // pieces of the path
const LONGEST_M = 0.5;
const LONGEST_US = 500_000;

// The path so far, as pieces between successive poses; a jump leaves a gap.
export class Trail {
  private readonly lines: Lines;
  private n = 0;
  private last: Pose | null = null;

  constructor(width: number) {
    this.lines = new Lines(MOST, width);
  }

  get object() {
    return this.lines.object;
  }

  setColor(css: string): void {
    this.lines.setColor(css);
  }

  clear(): void {
    this.n = 0;
    this.last = null;
    this.lines.setCount(0);
  }

  add(pose: Pose): void {
    const before = this.last;
    this.last = pose;
    if (!before) return;
    const distance = Math.hypot(...pose.position.map((x, i) => x - before.position[i]!));
    const time = pose.utime - before.utime;
    if (distance > LONGEST_M || time <= 0 || time > LONGEST_US) return;
    this.lines.set(this.n % MOST, before.position, pose.position); // the oldest gives way
    this.n += 1;
    this.lines.setCount(Math.min(this.n, MOST));
  }
}
