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
  /// messages) over the last two intervals between updates; no channel has two senders, or one that does not
  /// number its messages.
  const std::string& text() const { return text_; }

 private:
  // What senders do wrong, from SequenceCounter's counters.
  static std::string Senders(const std::map<std::string, std::int64_t>& counters);

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
