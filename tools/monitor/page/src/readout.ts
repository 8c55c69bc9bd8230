import type { Pose, WindowState } from "./frames";

// Figures of the readout as texts.

export function positionText(pose: Pose): string {
  return `${pose.position.map((x) => x.toFixed(2).padStart(6)).join(" ")} m`;
}

export function speedText(pose: Pose): string {
  return `${Math.hypot(...pose.velocity).toFixed(2)} m/s`;
}

// Standard deviations of position and of orientation.
export function sigmasText({ covariance }: WindowState): string {
  const root = (...at: number[]) => Math.sqrt(at.reduce((sum, i) => sum + Math.max(0, covariance[7 * i]!), 0));
  return `${(1000 * root(0, 1, 2)).toFixed(1)} mm  ${((root(3, 4, 5) * 180) / Math.PI).toFixed(2)}°`;
}
