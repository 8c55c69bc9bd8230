import type { Status } from "./status";

// The foot of the page: how much of the map is there, how fast it is drawn, who else watches.
export function aboutText(status: Status, figures: Record<string, number>): string {
  const known = status.map?.known ?? 0;
  const total = Math.max(known, status.map?.total ?? 0);
  const points = known ? `${known.toLocaleString("en")}${known < total ? ` of ${total.toLocaleString("en")}` : ""} map points` : "no map";
  const drawn = figures.drawn! < figures.points! ? `, ${figures.drawn!.toLocaleString("en")} drawn` : "";
  const viewers = `${status.viewers} viewer${status.viewers === 1 ? "" : "s"}`;
  return [points + drawn, figures.framesPerSecond! > 5 && `${figures.framesPerSecond} frames/s`, viewers, status.read_only && "read-only"].filter(Boolean).join(" · ");
}
