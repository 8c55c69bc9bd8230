#include "common/tracking/start_chain.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "common/geometry/degrees.h"
#include "common/tracking/alignment_significance.h"

namespace evit {
namespace {

constexpr std::size_t kMaxFrames = 300;
constexpr std::size_t kLongestDoubt = 100;  // frames of a chain that may be false, before it is given up
constexpr int kRivalSearches = 3;    // before a start counts: one misses the right pose one time in eight
constexpr double kMostRanges = 4;    // that rivals are looked for in
constexpr double kWideSearch = 1.5;  // start errors: from here on the range of a start is too narrow
constexpr std::int64_t kBetweenSearches = 5;  // frames: another one may show a rival that the first did not
constexpr double kLongestWait = 2;            // s: for motion, where frames have few events

// Of a start pose, in ranges of a start search.
double InRanges(double position, double rotation) {
  return std::max(position / kStartRange.position, rotation / kStartRange.rotation);
}

bool Beats(const StartRival& rival) { return rival.distinct && rival.significance <= 0; }

}  // namespace

void StartChain::Start(const BodyState& state) {
  least_start_error_ = 1;
  Restart(state);
}

void StartChain::Restart(const BodyState& state) {
  anchored_at_ = 0;
  if (state.velocity.isZero()) {
    anchor_.Start(state.T_map_body);
  } else {
    anchor_.Start(state.T_map_body, state.velocity);
  }
  Break();
}

void StartChain::Begin(Utime t) {
  if (anchored_at_ == 0) anchored_at_ = t;
}

void StartChain::Add(Frame frame) {
  if (frames_.empty()) {
    const SE3 &anchor = anchor_.pose(), &T_map_body = frame.frame.T_map_body;
    begin_.t = frame.frame.t;
    begin_.position = T_map_body.p - anchor.p;
    begin_.rotation = AngularDistance(anchor.q, T_map_body.q);
    // With a gyro the anchor follows the body while frames do not fit; without one it stays where it is.
    const bool moves = by_gyro_ && !anchor_.velocity().isZero();
    begin_.seconds = moves ? 0 : ToSeconds(begin_.t - anchored_at_);
  }
  frames_.push_back(std::move(frame));
  if (frames_.size() > kMaxFrames) frames_.erase(frames_.begin());
}

void StartChain::Break() {
  frames_.clear();
  unrivaled_ = false;
  n_clear_ = 0;
}

StartChain::Verdict StartChain::Judge(const SurfaceField& field, const AlignmentPoints& points) {
  if (!unrivaled_) start_error_ = StartError();
  if (!Agrees()) return frames_.size() >= kLongestDoubt ? Verdict::kFalse : Verdict::kUnsure;
  if (!unrivaled_) {
    const Verdict verdict = LookForRivals(field, points);
    if (verdict != Verdict::kFound) return verdict;
    unrivaled_ = true;
  }
  const Frame& newest = frames_.back();
  // Only now the anchor moves: were the chain false, the anchor would have lost where the body was.
  least_start_error_ = 1;
  anchor_.Start(newest.frame.T_map_body, RecentVelocity());
  anchored_at_ = newest.frame.t;
  if (!HasSeenEnough()) return Verdict::kFound;
  const Verdict verdict = looked_at_ == newest.seq ? Verdict::kFound : RuleOutRivals(field, points);
  return verdict == Verdict::kFound ? Verdict::kProven : verdict;
}

// What the body's motion before the chain, at the velocity that it has in the chain, does not explain of it.
double StartChain::StartError() const {
  const BootstrapFrame &first = frames_.front().frame, &last = frames_.back().frame;
  Eigen::Vector3d moved = Eigen::Vector3d::Zero();
  if (HasMoved()) {  // else that velocity is noise
    const Eigen::Vector3d velocity = (last.T_map_body.p - first.T_map_body.p) / ToSeconds(last.t - first.t);
    const double along = velocity.dot(begin_.position) / std::max(velocity.squaredNorm(), 1e-12);
    moved = std::clamp(along, 0.0, std::max(begin_.seconds, 0.0)) * velocity;
  }
  const double error = InRanges((begin_.position - moved).norm(), begin_.rotation);
  return std::clamp(error, least_start_error_, kMostRanges);
}

double StartChain::MeanSignificance() const {
  double sum = 0;
  for (const Frame& f : frames_) sum += f.significance;
  return sum / static_cast<double>(frames_.size());
}

// Whether the chain explains its events better than a false one does: a single frame of that may look as
// sure, ten in a row do not. A place that is farther off than a start may be has more to prove, unless the
// body moves: single frames lose a fast one soon, and so a false chain. Without a gyro they may follow it.
bool StartChain::Agrees() const {
  const double times = unrivaled_ || (by_gyro_ && HasMoved()) ? 1 : start_error_;
  const double needed =
      std::min(times * options_.min_frames, std::max(0.5 * kLongestDoubt, 1.0 * options_.min_frames));
  return static_cast<double>(frames_.size()) >= needed && MeanSignificance() >= kFoundSignificance;
}

// Before the first pose is reported. Without a gyro nothing but such searches contradicts a place that is
// farther off than a start may be: several in different frames must find nothing.
StartChain::Verdict StartChain::LookForRivals(const SurfaceField& field, const AlignmentPoints& points) {
  if (n_clear_ > 0 && frames_.back().seq - looked_at_ < kBetweenSearches) return Verdict::kUnsure;
  const Verdict verdict = RuleOutRivals(field, points);
  if (verdict != Verdict::kFound) {
    n_clear_ = 0;
    return verdict == Verdict::kDoubted ? Verdict::kUnsure : verdict;
  }
  ++n_clear_;
  return by_gyro_ || n_clear_ >= std::lround(start_error_) ? Verdict::kFound : Verdict::kUnsure;
}

// A false lock may look as certain as the right pose while no other is known: before the first pose is
// reported, and again before a start counts as proven, no other pose may explain the newest frame as well.
// kDoubted where one does; where one explains it better the chain starts again from there.
StartChain::Verdict StartChain::RuleOutRivals(const SurfaceField& field, const AlignmentPoints& points) {
  const SE3 pose = frames_.back().frame.T_map_body;
  looked_at_ = frames_.back().seq;
  const auto find = [&](double times) {
    const StartRange range{times * kStartRange.position, times * kStartRange.rotation, kStartRange.levels};
    return FindRival(alignment_, field, points, pose, range, looked_at_,
                     static_cast<int>(std::lround(times * kRivalSearches)));
  };
  StartRival rival = find(1);
  // Where the start pose turned out to be wrong by more than a little, the right pose may be as far again.
  if (!Beats(rival) && start_error_ > kWideSearch) rival = find(start_error_);
  // Without a gyro nothing else contradicts it: the start pose itself says where the right pose is.
  if (!Beats(rival) && !by_gyro_ && !unrivaled_ && start_error_ > 1)
    rival = FindRivalAround(alignment_, field, points, pose, anchor_.pose(), kStartRange, looked_at_,
                            kRivalSearches);
  if (!Beats(rival)) return Verdict::kFound;
  if (rival.significance >= -kPreferredSignificance) return Verdict::kDoubted;
  const SE3& anchor = anchor_.pose();
  const double error =
      InRanges((rival.T_map_body.p - anchor.p).norm(), AngularDistance(rival.T_map_body.q, anchor.q));
  // Once the anchor has moved to the false place, it says nothing of the start pose any more.
  least_start_error_ = std::clamp(error, unrivaled_ ? start_error_ : least_start_error_, kMostRanges);
  BodyState start;
  start.T_map_body = rival.T_map_body;
  Restart(start);
  return Verdict::kElsewhere;
}

void StartChain::DropHalf() {
  frames_.erase(frames_.begin(), frames_.begin() + static_cast<std::ptrdiff_t>(frames_.size() / 2));
  begin_.t = frames_.front().frame.t;  // the rest has to last as long again
}

std::vector<StartChain::Frame> StartChain::Take() { return std::exchange(frames_, {}); }

Eigen::Vector3d StartChain::RecentVelocity() const {
  if (frames_.size() < 2) return Eigen::Vector3d::Zero();
  const BootstrapFrame& a = frames_[frames_.size() > 5 ? frames_.size() - 5 : 0].frame;
  const BootstrapFrame& b = frames_.back().frame;
  return (b.T_map_body.p - a.T_map_body.p) / ToSeconds(b.t - a.t);
}

bool StartChain::HasMoved() const {
  const SE3 &first = frames_.front().frame.T_map_body, &last = frames_.back().frame.T_map_body;
  return (last.p - first.p).norm() >= options_.min_displacement_m ||
         AngularDistance(first.q, last.q) >= options_.min_rotation_deg * kRadiansPerDegree;
}

bool StartChain::HasSeenEnough() const {
  if (static_cast<int>(frames_.size()) < std::max(options_.min_frames, 3)) return false;
  const double seconds = ToSeconds(frames_.back().frame.t - begin_.t);
  if ((by_gyro_ && HasMoved()) || seconds >= std::max(kLongestWait, options_.max_duration_s)) return true;
  if (seconds < options_.max_duration_s || frames_.back().seq - looked_at_ < kBetweenSearches) return false;
  if (HasMoved()) return true;
  // Frames of few events know the velocity badly, and the window would coast on it until more come.
  double events = 0;
  for (const Frame& f : frames_) events += f.n_events;
  return events >= static_cast<double>(frames_.size()) * min_events_;
}

}  // namespace evit
