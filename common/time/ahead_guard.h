#pragma once

#include <optional>
#include <utility>

#include "common/time/utime.h"

namespace evit {

/// Keeps one stamp in the future from making all that follows late, where nothing can be looked ahead at: an
/// item (anything with a stamp `t`, us) more than `kAhead` ahead of the newest one waits for the next. If
/// that is as late, there was a gap, and both are good; if it is not, the one that waited was wrong.
template <typename Item>
class AheadGuard {
 public:
  static constexpr Utime kAhead = 500'000;  // us

  /// Calls `use` for each item that is good now, in the order they came, and `drop` for one that was wrong.
  template <typename Use, typename Drop>
  void Push(Item item, const Use& use, const Drop& drop) {
    if (waiting_) {
      Item held = std::move(*waiting_);
      waiting_.reset();
      if (item.t >= held.t - kAhead) {
        Accept(std::move(held), use);
      } else {
        drop(held);
      }
    }
    if (newest_ && item.t > *newest_ + kAhead) {
      waiting_ = std::move(item);
      return;
    }
    Accept(std::move(item), use);
  }
  /// Nothing more will come: what waits is good.
  template <typename Use>
  void Flush(const Use& use) {
    if (waiting_) Accept(std::move(*waiting_), use);
    waiting_.reset();
  }
  /// The next item begins a new stream.
  void Clear() {
    waiting_.reset();
    newest_.reset();
  }

 private:
  template <typename Use>
  void Accept(Item item, const Use& use) {
    newest_ = item.t;  // also where it goes back: what a clock that was set does is for others to judge
    use(item);
  }

  std::optional<Item> waiting_;
  std::optional<Utime> newest_;
};

}  // namespace evit
