#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "common/bus/log_file.h"

namespace evit {

/// The streams of an LCM log that are replayed, in the order of the log.
class Recording {
 public:
  /// The first two equal SendWindow::Stream.
  enum Kind { kEvents = 0, kImu = 1, kGroundTruth = 2 };

  /// `prefix`: of the channel names in the log; empty: found (FindLogPrefix). Throws std::runtime_error,
  /// naming file and remedy, where the log is missing, unreadable, empty, no LCM log or without EVENTS; also
  /// where it is cut off in the middle of a message, unless `allow_truncated`.
  Recording(const std::string& path, const std::string& prefix, bool allow_truncated = false);

  const std::string& path() const { return path_; }
  std::size_t size() const { return messages_.size(); }
  Kind kind(std::size_t i) const { return messages_[i].kind; }
  /// Log time stamp of message i, us: when it is due.
  std::int64_t utime(std::size_t i) const { return messages_[i].entry.utime; }
  std::int64_t begin_utime() const { return utime(0); }
  std::int64_t end_utime() const { return messages_.back().entry.utime; }
  std::int32_t bytes(std::size_t i) const { return messages_[i].entry.size; }

  /// A number that differs between recordings (size and time span).
  std::int64_t fingerprint() const {
    return static_cast<std::int64_t>(size()) * 1'000'003 ^ begin_utime() ^ end_utime() << 1;
  }

  /// First message at or after `utime`; size() where there is none.
  std::size_t FirstAt(std::int64_t utime) const;

  /// Reads the bytes of message i (memory reused). Throws std::runtime_error where the file has changed.
  void Read(std::size_t i, std::vector<std::uint8_t>* data) const { log_.Read(messages_[i].entry, data); }

 private:
  struct Message {
    LogEntry entry;
    Kind kind;
  };

  std::string path_;
  LogReader log_;
  std::vector<Message> messages_;
};

}  // namespace evit
