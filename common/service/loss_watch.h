#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace evit {

/// Notices from a service's counters which channels lose messages at the moment.
class LossWatch {
 public:
  /// Reads the counters; call once a second or so.
  void Update(const std::map<std::string, std::int64_t>& counters);
  /// A sentence for a person, empty where all is well: no channel lost more than 1 % (and at least three
  /// messages) between the last update but two and the last.
  const std::string& text() const { return text_; }

 private:
  struct Count {
    std::int64_t lost = 0, received = 0;
  };
  struct Seen {
    Count before_last, last;
  };
  std::map<std::string, Seen> seen_;
  std::string text_;
};

}  // namespace evit
