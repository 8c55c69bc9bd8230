#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace evit {

/// Where one message lies in an LCM log file.
struct LogEntry {
  std::int64_t
      utime;  // us: time stamp of the log (data time in logs of `evit import`, receive time in lcm-logger's)
  std::int64_t offset;   // of the message's bytes in the file
  std::int32_t size;     // bytes
  std::int32_t channel;  // index into LogReader::channels()
};

/// An LCM log file (lcm-logger's format), indexed when it is opened. LCM's own reader reserves what a length
/// field claims and cannot tell a cut file from a whole one; this one checks lengths against the file, and
/// knows.
class LogReader {
 public:
  /// Throws std::runtime_error, naming file and remedy, where the file cannot be read or holds no message at
  /// all.
  explicit LogReader(const std::string& path);

  /// All messages, in the order of the file.
  const std::vector<LogEntry>& entries() const { return entries_; }
  const std::vector<std::string>& channels() const { return channels_; }
  const std::string& channel(const LogEntry& entry) const { return channels_[entry.channel]; }

  /// Reads the bytes of one message into `data` (memory reused). Throws std::runtime_error where the file has
  /// changed.
  void Read(const LogEntry& entry, std::vector<std::uint8_t>* data) const;

  /// Bytes after the last whole message: 0 unless the file was cut off or is damaged there.
  std::int64_t trailing_bytes() const { return trailing_bytes_; }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::int32_t ChannelIndex(const std::string& name);
  void BuildIndex(std::int64_t file_size);

  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;
  std::vector<LogEntry> entries_;
  std::vector<std::string> channels_;
  std::int64_t trailing_bytes_ = 0;
};

/// Writes an LCM log file, readable by every LCM tool.
class LogWriter {
 public:
  /// Throws std::runtime_error where the file cannot be made.
  explicit LogWriter(const std::string& path);
  ~LogWriter();
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;

  /// Appends one message with time stamp `utime` (us). Throws std::runtime_error where the disk takes no
  /// more.
  void Write(std::int64_t utime, const std::string& channel, const void* data, std::size_t size);

  /// Flushes and closes; throws where that fails. A writer destroyed without it closes in silence.
  void Close();

 private:
  std::string path_;
  std::FILE* file_;
  std::int64_t count_ = 0;
};

}  // namespace evit
