#include "common/alignment/event_flow.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace evit {
namespace {

constexpr std::int64_t kFewestEvents = 300;  // events in a window
constexpr int kMaxShift = 60;                // pixels between two windows: 3000 pixels/s
constexpr int kBlur = 2;                     // pixels

// Blurred, and with its mean taken away: what is left is where edges are.
std::vector<float> Prepared(const std::vector<float>& counts) {
  const int n = static_cast<int>(counts.size());
  std::vector<float> out(counts.size());
  double sum = 0;
  for (int k = 0; k < n; ++k) {
    for (int d = -kBlur; d <= kBlur; ++d) {
      if (k + d >= 0 && k + d < n) out[k] += counts[k + d];
    }
    sum += out[k];
  }
  for (float& v : out) v -= static_cast<float>(sum / n);
  return out;
}

// The shift of b against a with the highest correlation, to a fraction of a pixel; false where none stands
// out.
bool Shift(const std::vector<float>& a, const std::vector<float>& b, double* shift) {
  const int n = static_cast<int>(a.size()), range = std::min(kMaxShift, n / 4);
  std::vector<double> score(2 * range + 1);
  for (int s = -range; s <= range; ++s) {
    double ab = 0, aa = 0, bb = 0;
    for (int k = std::max(0, -s); k < std::min(n, n - s); ++k) {
      ab += a[k] * b[k + s];
      aa += a[k] * a[k];
      bb += b[k + s] * b[k + s];
    }
    score[s + range] = aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
  }
  const auto best = static_cast<int>(std::max_element(score.begin(), score.end()) - score.begin());
  if (best == 0 || best == 2 * range || score[best] < 0.5) return false;
  const double left = score[best - 1], right = score[best + 1], curve = left - 2 * score[best] + right;
  *shift = best - range + (curve < 0 ? 0.5 * (left - right) / curve : 0);
  return true;
}

}  // namespace

EventFlow::EventFlow(int width, int height) {
  for (Counts* counts : {&now_, &before_}) {
    counts->x.resize(static_cast<std::size_t>(width));
    counts->y.resize(static_cast<std::size_t>(height));
  }
}

void EventFlow::Close() {
  double dx = 0, dy = 0;
  if (now_.n >= kFewestEvents && before_.n >= kFewestEvents &&
      Shift(Prepared(before_.x), Prepared(now_.x), &dx) &&
      Shift(Prepared(before_.y), Prepared(now_.y), &dy)) {
    samples_.push_back({end_ - kWindow, dx / ToSeconds(kWindow), dy / ToSeconds(kWindow)});
  }
  std::swap(now_, before_);
  std::fill(now_.x.begin(), now_.x.end(), 0.F);
  std::fill(now_.y.begin(), now_.y.end(), 0.F);
  now_.n = 0;
  end_ += kWindow;
}

void EventFlow::Add(const EventArray& events) {
  for (std::size_t k = 0; k < events.size(); ++k) {
    const Utime t = events.t[k];
    if (end_ == 0) end_ = t + kWindow;
    if (t >= end_ + 2 * kWindow) {  // silence: the windows begin again behind it
      Close();
      Close();
      end_ = t + kWindow;
    }
    while (t >= end_) Close();
    if (events.x[k] >= now_.x.size() || events.y[k] >= now_.y.size()) continue;
    ++now_.x[events.x[k]];
    ++now_.y[events.y[k]];
    ++now_.n;
  }
}

}  // namespace evit
