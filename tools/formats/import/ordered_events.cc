#include "tools/formats/import/ordered_events.h"

#include "tools/formats/import/latest_time.h"

namespace evit::formats {
bool OrderedEvents::Read(EventArray* events) {
  events->clear();
  while (events->size() == 0 && more_) {
    more_ = source_->Read(&piece_);
    for (std::size_t k = 0; more_ && k < piece_.size(); ++k) {
      const Utime t = piece_.t[k];
      if (t > kLatestTime || t < -kLatestTime) {
        ++n_impossible_;
      } else {
        order_.Push({wrap_.Continue(t), piece_.x[k], piece_.y[k], piece_.p[k]});
      }
    }
    if (!more_) order_.Finish();
    for (const Event& e : order_.Take()) events->push_back(e.t, e.x, e.y, e.p);
  }
  return events->size() > 0;
}

DropCounts OrderedEvents::dropped() const {
  DropCounts dropped = source_->dropped();
  dropped.Add(order_.counts());
  dropped.outlier += n_impossible_;
  return dropped;
}

}  // namespace evit::formats
