import type { Order } from "./connection";
import { element, setText } from "./dom";
import { isOver, placeOf } from "./headline";
import { isSilent } from "./services_view";
import type { Status } from "./status";

const HOLD_MS = 1500; // after an order, until STATUS has caught up

// Play, pause, speed and place of a replayed log.
export class ReplayBar {
  private readonly slider = element<HTMLInputElement>("seek");
  private readonly button = element<HTMLButtonElement>("play");
  private readonly speed = element<HTMLSelectElement>("replay-speed");
  private paused = false;
  private atEnd = false;
  private heldUntil = 0;
  private speedHeldUntil = 0;

  constructor(private readonly send: (order: Order) => void) {
    this.button.onclick = () => {
      this.hold();
      if (this.atEnd) {
        this.atEnd = false;
        this.send({ order: "seek", share: 0 });
        return this.showPaused(false);
      }
      this.send({ order: this.paused ? "resume" : "pause" });
      this.showPaused(!this.paused);
    };
    this.slider.oninput = () => this.hold();
    this.slider.onchange = () => {
      this.hold();
      this.send({ order: "seek", share: Number(this.slider.value) / 1000 });
    };
    this.speed.onchange = () => {
      this.speedHeldUntil = performance.now() + HOLD_MS;
      this.send({ order: "speed", speed: Number(this.speed.value) });
    };
  }

  show(status: Status): void {
    const replay = status.services.find((service) => service.name === "log_replay");
    const over = isOver(status);
    const usable = !!replay && !status.read_only && !isSilent(replay) && !over;
    element("replay").hidden = !replay;
    for (const control of [this.slider, this.button, this.speed]) control.disabled = !usable;
    if (!replay) return;
    this.button.title = over ? "the run has ended: nobody plays it any more" : "";
    if (placeOf(replay)) setText("place", placeOf(replay));
    this.showSpeed((replay.counters.speed_percent ?? 100) / 100);
    if (performance.now() < this.heldUntil) return;
    this.atEnd = replay.progress >= 1;
    this.showPaused(replay.state === "paused" || this.atEnd);
    this.slider.value = String(Math.round(1000 * Math.max(0, replay.progress)));
  }

  private hold(): void {
    this.heldUntil = performance.now() + HOLD_MS;
  }

  // Any speed: the one it was started with need not be in the list.
  private showSpeed(speed: number): void {
    if (performance.now() < this.speedHeldUntil || document.activeElement === this.speed) return;
    const value = speed > 0 ? String(speed) : "";
    const options = [...this.speed.options];
    if (!options.some((option) => option.value === value)) {
      for (const option of options) if (option.dataset.extra) option.remove();
      const extra = new Option(speed > 0 ? `${speed}×` : "as fast as it goes", value);
      extra.dataset.extra = "yes";
      this.speed.add(extra, 0);
    }
    this.speed.value = value;
  }

  private showPaused(paused: boolean): void {
    this.paused = paused;
    this.button.textContent = paused ? "Play" : "Pause";
  }
}
