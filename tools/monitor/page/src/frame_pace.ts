const SLOW_MS = 24; // a frame that takes longer: fewer points
const FAST_MS = 17.8; // more points
const STILL_MS = 250; // since the last frame: nothing moves

// Counts the frames of a view that is drawn only when something has changed. Says what share of the map the graphics can
// draw in time; where even the smallest takes too long, every other moment is left to the rest of the page.
export class FramePace {
  share = 1;
  private last = 0;
  private took = 16.7; // ms, from a frame to the next that the screen could show; smoothed
  private pending = false;
  private readonly stamps: number[] = []; // of the last frames, ms

  // The screen can show a frame.
  tick(now: number): void {
    if (!this.pending) return;
    this.pending = false;
    this.took += 0.3 * (Math.min(500, now - this.last) - this.took);
    if (this.took > SLOW_MS) this.share = Math.max(0.02, this.share * Math.min(0.95, Math.max(0.5, SLOW_MS / this.took)));
    else if (this.took < FAST_MS) this.share = Math.min(1, 1.03 * this.share);
  }

  // ms that what is drawn beside this view should leave between two drawings of its own.
  get pause(): number {
    return 8 * this.took;
  }

  // Whether it is this view's turn.
  due(now: number): boolean {
    return this.took <= SLOW_MS || now - this.last >= 2 * this.took;
  }

  // A frame is drawn now.
  add(now: number): void {
    this.last = now;
    this.pending = true;
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
