#include "tools/paper/jerk.h"

namespace evit::paper {

Utime MostJerky(const Trajectory& trajectory, double before, double after) {
  constexpr Utime kStep = 25'000;  // us: about a keyframe's interval
  const auto us = [](double s) { return static_cast<Utime>(1e6 * s); };
  const Utime first = trajectory.front().t, last = trajectory.back().t;
  Utime best = first + (last - first) / 2;
  double most = -1;
  for (Utime t = first + us(before); t <= last - us(after); t += kStep / 5) {
    SE3 a, b, c;
    if (!PoseAt(trajectory, t - kStep, &a) || !PoseAt(trajectory, t, &b) ||
        !PoseAt(trajectory, t + kStep, &c))
      continue;
    const double change = (LogSO3(b.q.conjugate() * c.q) - LogSO3(a.q.conjugate() * b.q)).norm();
    if (change > most) most = change, best = t;
  }
  return best;
}

}  // namespace evit::paper
