#pragma once

#include <atomic>
#include <cstddef>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/localization/place_index.h"
#include "common/map/map_index.h"
#include "evit/place_query_t.hpp"
#include "evit/places_t.hpp"

namespace evit {

/// Answers in a thread of its own where a keyframe may have been seen from, one question at a time. The first
/// time it makes the index of places, or reads it.
class PlaceWorker {
 public:
  /// `map` must outlive this.
  explicit PlaceWorker(const MapIndex* map) : map_(map) {}
  ~PlaceWorker() { stopping_ = true; }
  PlaceWorker(const PlaceWorker&) = delete;
  PlaceWorker& operator=(const PlaceWorker&) = delete;

  /// Where the index is kept (PlaceIndexPaths). Before the first Begin().
  void KeepIn(const std::vector<std::string>& paths) { paths_ = paths; }
  /// Not while busy. Without a question only the index is made.
  void Begin(std::optional<place_query_t> question);
  bool busy() const { return work_.valid(); }
  /// Whether the work is done, and Take() does not wait.
  bool Done() const;
  /// Ends the work; its answer, without number and epoch of the sender. Throws what making it threw.
  std::optional<places_t> Take() { return work_.get(); }

  double prepared() const { return prepared_; }  // 0..1: of the index
  // After the first work:
  std::size_t n_places() const { return index_->places().size(); }
  bool index_read() const { return index_read_; }  // from its file

 private:
  places_t Answer(const place_query_t& question) const;
  void MakeIndex();

  const MapIndex* map_;
  std::vector<std::string> paths_;           // none: not kept
  std::unique_ptr<const PlaceIndex> index_;  // the thread's, while it works
  bool index_read_ = false;                  // the thread's, too
  std::atomic<double> prepared_{0};
  std::atomic<bool> stopping_{false};
  std::future<std::optional<places_t>> work_;  // last member: the thread ends before anything else is gone
};

}  // namespace evit
