import { color, element, isDark } from "./dom";
import type { MapView } from "./map_view";

// Says what the colours of the 3-D view stand for: of what is there.
export function showLegend(view: MapView, shown: { poseSent: boolean; candidates: boolean }): void {
  const { body, cloud, gridStep } = view;
  const [low, high] = cloud.heights.toArray().map((z) => (Math.round(10 * z) / 10 || 0).toFixed(1).replace("-", "−"));
  const line = (name: string, text: string) => `<span><i style="background:var(--${name})"></i>${text}</span>`;
  const parts = [
    body.hasPose && (body.isKnown ? line("accent", "estimate") : line("soft", "where it was last")),
    shown.poseSent && line("bad", "pose sent"),
    view.hasTruth && line("truth", "truth"),
    shown.candidates && line("place", "where it may be"),
    gridStep > 0 && `<span><i class="ramp" style="background:linear-gradient(90deg, ${cloud.setTheme(isDark())})"></i>height ${low} to ${high} m</span>`,
    gridStep > 0 && line("grid", `grid ${gridStep} m`),
  ];
  const html = parts.filter(Boolean).join("");
  const legend = element("map-legend");
  if (legend.innerHTML !== html) legend.innerHTML = html;
  legend.style.color = color("soft");
}
