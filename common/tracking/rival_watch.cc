#include "common/tracking/rival_watch.h"

#include <algorithm>

#include "common/tracking/alignment_significance.h"
#include "common/tracking/gates.h"

namespace evit {
namespace {

constexpr Utime kProbation = 1'000'000;  // us
constexpr Utime kClosely = 200'000;      // us between searches in it
constexpr Utime kUsually = 2'000'000;    // us: a search takes as long as some keyframes
constexpr Utime kCoasting = 50'000;      // us: the pose drifts away, the right one may be near
constexpr int kConfirmations = 3;        // keyframes
// By how much a rival must win. In 1,050 keyframes with the right pose, most of them fast, ten rivals did so;
// none was found again in the next keyframe. At false poses 95 % of the searches find the right one, by 6
// to 8.
constexpr double kWins = 3;
constexpr double kSamePlace = 0.05;  // m, rad

}  // namespace

void RivalWatch::Start(Utime t) {
  started_at_ = searched_at_ = t;
  confirmations_ = 0;
}

std::optional<SE3> RivalWatch::Search(const AlignmentSettings& settings, const PointSelector& points,
                                      const KeyframeInput& keyframe, const BodyState& state,
                                      const Eigen::Vector3d& rate, bool coasting) {
  if (!Due(keyframe.t, coasting)) return std::nullopt;
  // With more points the pose of this keyframe would come too late, as the search comes before it.
  constexpr int kEnough = 4000;
  const int n = std::min(points.affordable(), kEnough);
  const AlignmentPoints some = points.Select(state, rate, n, keyframe.seq);
  if (some.size() < kMinPoints) return std::nullopt;
  const SurfaceField field(keyframe.surface, kStartRange.levels);
  const SE3& pose = state.T_map_body;
  const StartRival rival = FindRival(settings, field, some, pose, kStartRange, keyframe.seq);
  return Confirm(keyframe.t, pose, rival, AlignmentSignificance(settings, field, some, rival.T_map_body));
}

bool RivalWatch::Due(Utime t, bool coasting) const {
  if (confirmations_ > 0) return true;
  const Utime interval = coasting ? kCoasting : t - started_at_ <= kProbation ? kClosely : kUsually;
  return t - searched_at_ >= interval;
}

std::optional<SE3> RivalWatch::Confirm(Utime t, const SE3& T_map_body, const StartRival& rival,
                                       double rival_significance) {
  searched_at_ = t;
  if (!rival.distinct || rival.significance > -kWins || rival_significance < kStartSignificance) {
    confirmations_ = 0;
    return std::nullopt;
  }
  const SE3 T_body_rival = T_map_body.Inverse() * rival.T_map_body;
  const bool same = (T_body_rival.p - T_body_rival_.p).norm() < kSamePlace &&
                    AngularDistance(T_body_rival.q, T_body_rival_.q) < kSamePlace;
  confirmations_ = same ? confirmations_ + 1 : 1;
  T_body_rival_ = T_body_rival;
  if (confirmations_ < kConfirmations) return std::nullopt;
  confirmations_ = 0;
  return rival.T_map_body;
}

}  // namespace evit
