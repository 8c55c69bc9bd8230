const SLOW_MS = 24; // between two frames: fewer points
const FAST_MS = 17.8; // more points
const STILL_MS = 250; // since the last frame: nothing moves

// Counts the frames of a view that is drawn only when something has changed, and says what share of the map the
// graphics can draw in time.
export class FramePace {
  share = 1;
  private last = 0;
  private interval = 16.7;
  private readonly stamps: number[] = []; // of the last frames, ms

  // A frame is drawn now. `streak`: so was the last one that the screen could show.
  add(now: number, streak: boolean): void {
    if (streak) {
      this.interval += 0.15 * (Math.min(200, now - this.last) - this.interval);
      if (this.interval > SLOW_MS) this.share = Math.max(0.02, 0.9 * this.share);
      else if (this.interval < FAST_MS) this.share = Math.min(1, 1.03 * this.share);
    }
    this.last = now;
    this.stamps.push(now);
    while (this.stamps.length > 600 || now - this.stamps[0]! > 5000) this.stamps.shift();
  }

  still(now: number): boolean {
    return now - this.last > STILL_MS;
  }

  // Frames drawn in the last second.
  rate(now: number): number {
    return this.stamps.filter((stamp) => now - stamp <= 1000).length;
  }
}
