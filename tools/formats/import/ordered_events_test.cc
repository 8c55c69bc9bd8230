#include "tools/formats/import/ordered_events.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace evit::formats {
namespace {

// Events 10 us apart in pieces of 100, those of each 10 ms by row and not by time, one far ahead.
class Unsorted : public EventSource {
 public:
  bool Read(EventArray* events) override {
    events->clear();
    for (int k = 0; k < 100 && n_ < 50'000; ++k, ++n_) {
      const int in_batch = n_ % 1000;
      Utime t = 10 * (n_ - in_batch + (in_batch * 7) % 1000);
      if (n_ == 20'000) t += 500'000'000;
      events->push_back(t, static_cast<std::uint16_t>(n_ % 640), 3, 1);
    }
    return events->size() > 0;
  }
  double share() const override { return n_ / 50'000.0; }
  std::string name() const override { return "unsorted"; }

 private:
  int n_ = 0;
};

TEST(OrderedEvents, BatchesAreSortedAndAnOutlierDropped) {
  Unsorted source;
  OrderedEvents ordered(&source);
  EventArray all, piece;
  while (ordered.Read(&piece)) {
    for (std::size_t k = 0; k < piece.size(); ++k)
      all.push_back(piece.t[k], piece.x[k], piece.y[k], piece.p[k]);
  }
  EXPECT_EQ(all.size(), 49'999U);
  EXPECT_TRUE(std::is_sorted(all.t.begin(), all.t.end()));
  EXPECT_EQ(ordered.dropped().outlier, 1);
  EXPECT_EQ(ordered.dropped().total(), 1);
  EXPECT_GT(ordered.dropped().sorted, 10'000);
}

}  // namespace
}  // namespace evit::formats
