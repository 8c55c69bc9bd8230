#include "common/service/send_window.h"

#include <algorithm>

namespace evit {

namespace {

constexpr std::int64_t kLongestPatienceUs = 1'000'000;

}  // namespace

SendWindow::SendWindow(const std::vector<std::string>& consumers, std::int64_t limit_bytes,
                       std::int64_t timeout_us)
    : limit_(limit_bytes), timeout_us_(timeout_us), patience_us_(timeout_us) {
  for (const std::string& name : consumers) consumers_[name] = Consumer();
}

void SendWindow::Restart(std::int64_t stream_epoch) {
  stream_epoch_ = stream_epoch;
  sent_ = {0, 0};
  items_.clear();
  cursor_ = 0;
  under_way_ = 0;
  probing_ = false;
  patience_us_ = timeout_us_;
  for (auto& [name, consumer] : consumers_) consumer.next = {0, 0};
}

SendWindow::Verdict SendWindow::OnCredit(const credit_t& credit, std::int64_t now_us) {
  const auto found = consumers_.find(credit.consumer);
  if (found == consumers_.end()) return Verdict::kNotAwaited;
  Consumer& consumer = found->second;
  const bool new_run = consumer.heard && credit.epoch != consumer.epoch;
  const bool current = credit.stream_epoch == stream_epoch_;
  if (current && (credit.next_events_seq > sent_[kEvents] || credit.next_imu_seq > sent_[kImu])) {
    return Verdict::kImpossible;
  }
  consumer.heard = true;
  consumer.epoch = credit.epoch;
  consumer.heard_us = now_us;
  if (new_run && (consumer.next[kEvents] > 0 || consumer.next[kImu] > 0)) return Verdict::kRestarted;
  if (!current) return Verdict::kTaken;
  const std::array<std::int64_t, 2> next = {credit.next_events_seq, credit.next_imu_seq};
  for (int s = 0; s < 2; ++s) {
    // Credits may overtake each other: only forward.
    if (next[s] < 0 || consumer.next[s] < 0) {
      consumer.next[s] = -1;
    } else {
      consumer.next[s] = std::max(consumer.next[s], next[s]);
    }
  }
  Release(now_us);
  return Verdict::kTaken;
}

bool SendWindow::Acknowledged(const Item& item) const {
  return std::all_of(consumers_.begin(), consumers_.end(), [&item](const auto& entry) {
    const std::int64_t next = entry.second.next[item.stream];
    return next < 0 || item.seq < next;
  });
}

void SendWindow::Release(std::int64_t now_us) {
  bool moved = false;
  while (!items_.empty() && Acknowledged(items_.front())) {
    if (cursor_ > 0) {
      --cursor_;
      under_way_ -= items_.front().bytes;
    }
    items_.pop_front();
    moved = true;
  }
  if (!moved) return;
  moved_us_ = now_us;
  probing_ = false;
  patience_us_ = timeout_us_;
}

std::vector<std::string> SendWindow::missing_consumers() const {
  std::vector<std::string> names;
  for (const auto& [name, consumer] : consumers_) {
    if (!consumer.heard) names.push_back(name);
  }
  return names;
}

std::int64_t SendWindow::longest_silence(std::int64_t now_us) const {
  std::int64_t longest = 0;
  for (const auto& [name, consumer] : consumers_) {
    if (consumer.heard) longest = std::max(longest, now_us - consumer.heard_us);
  }
  return longest;
}

bool SendWindow::MaySend(std::int64_t bytes) const {
  if (under_way_ == 0) return true;
  return !probing_ && under_way_ + bytes <= limit_;
}

void SendWindow::Sent(const Item& item, std::int64_t now_us) {
  if (items_.empty()) moved_us_ = now_us;
  sent_[item.stream] = item.seq + 1;
  items_.push_back(item);
  if (cursor_ + 1 == items_.size()) {
    ++cursor_;
    under_way_ += item.bytes;
  }
  Release(now_us);  // at once where nobody consumes it
}

const SendWindow::Item* SendWindow::NextAgain() const {
  return cursor_ < items_.size() ? &items_[cursor_] : nullptr;
}

void SendWindow::SentAgain() {
  if (cursor_ == items_.size()) return;
  under_way_ += items_[cursor_].bytes;
  ++cursor_;
}

bool SendWindow::Stalled(std::int64_t now_us) const {
  return !items_.empty() && under_way_ != 0 && now_us - moved_us_ >= patience_us_;
}

void SendWindow::GoBack(std::int64_t now_us) {
  cursor_ = 0;
  under_way_ = 0;
  probing_ = true;
  moved_us_ = now_us;
  patience_us_ = std::min(2 * patience_us_, std::max(kLongestPatienceUs, timeout_us_));
}

}  // namespace evit
