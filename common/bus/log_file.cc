#include "common/bus/log_file.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace evit {

namespace {

// One message: sync word, number, time stamp, length of the channel name, length of the data, name, data.
constexpr std::uint32_t kSync = 0xEDA1DA01;
constexpr std::int64_t kHeader = 4 + 8 + 8 + 4 + 4;
constexpr std::uint32_t kMaxChannelName = 63;    // LCM's own limit
constexpr std::uint32_t kMaxMessage = 1U << 28;  // LCM's own limit, bytes

std::uint64_t GetBigEndian(const std::uint8_t* at, int bytes) {
  std::uint64_t value = 0;
  for (int i = 0; i < bytes; ++i) value = value << 8 | at[i];
  return value;
}

void PutBigEndian(std::uint64_t value, int bytes, std::uint8_t* at) {
  for (int i = bytes - 1; i >= 0; --i, value >>= 8) at[i] = static_cast<std::uint8_t>(value);
}

}  // namespace

LogReader::LogReader(const std::string& path) : path_(path), file_(std::fopen(path.c_str(), "rb")) {
  if (!file_) throw std::runtime_error("cannot open log " + path + ": " + std::strerror(errno));
  struct stat status = {};
  if (::fstat(::fileno(file_.get()), &status) != 0 || !S_ISREG(status.st_mode)) {
    throw std::runtime_error("log " + path + " is not a regular file");
  }
  if (status.st_size == 0) throw std::runtime_error("log " + path + " is empty");
  BuildIndex(status.st_size);
  if (entries_.empty()) {
    throw std::runtime_error("log " + path +
                             " holds no whole LCM message: is it an LCM log (lcm-logger, evit import)?");
  }
}

void LogReader::BuildIndex(std::int64_t file_size) {
  std::int64_t position = 0;
  std::array<std::uint8_t, kHeader + kMaxChannelName> head{};
  while (position + kHeader <= file_size) {
    // The file is read at this one place, so a plain seek per message is enough: headers are 50 kB apart.
    const auto expected = static_cast<std::size_t>(std::min<std::int64_t>(head.size(), file_size - position));
    if (::fseeko(file_.get(), position, SEEK_SET) != 0 ||
        std::fread(head.data(), 1, expected, file_.get()) != expected) {
      throw std::runtime_error("cannot read log " + path_ + ": " + std::strerror(errno));
    }
    const auto name_size = static_cast<std::uint32_t>(GetBigEndian(&head[20], 4));
    const auto data_size = static_cast<std::uint32_t>(GetBigEndian(&head[24], 4));
    if (GetBigEndian(head.data(), 4) != kSync || name_size == 0 || name_size > kMaxChannelName ||
        data_size > kMaxMessage || position + kHeader + name_size + data_size > file_size) {
      break;
    }
    LogEntry entry{};
    entry.utime = static_cast<std::int64_t>(GetBigEndian(&head[12], 8));
    entry.offset = position + kHeader + name_size;
    entry.size = static_cast<std::int32_t>(data_size);
    entry.channel = ChannelIndex(std::string(reinterpret_cast<const char*>(&head[kHeader]), name_size));
    entries_.push_back(entry);
    position = entry.offset + data_size;
  }
  trailing_bytes_ = file_size - position;
}

std::int32_t LogReader::ChannelIndex(const std::string& name) {
  const auto found = std::find(channels_.begin(), channels_.end(), name);
  const auto index = static_cast<std::int32_t>(found - channels_.begin());
  if (found == channels_.end()) channels_.push_back(name);
  return index;
}

void LogReader::Read(const LogEntry& entry, std::vector<std::uint8_t>* data) const {
  data->resize(static_cast<std::size_t>(entry.size));
  // Not by the stream: it would read each end of a message twice.
  for (std::size_t done = 0; done < data->size();) {
    const ssize_t n = ::pread(::fileno(file_.get()), data->data() + done, data->size() - done,
                              entry.offset + static_cast<std::int64_t>(done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) {
      throw std::runtime_error("cannot read log " + path_ + " at byte " + std::to_string(entry.offset) +
                               ": has it been changed since it was opened?");
    }
    done += static_cast<std::size_t>(n);
  }
}

LogWriter::LogWriter(const std::string& path) : path_(path), file_(std::fopen(path.c_str(), "wb")) {
  if (file_ == nullptr) throw std::runtime_error("cannot write log " + path + ": " + std::strerror(errno));
}

LogWriter::~LogWriter() {
  if (file_ != nullptr) std::fclose(file_);
}

void LogWriter::Write(std::int64_t utime, const std::string& channel, const void* data, std::size_t size) {
  if (channel.empty() || channel.size() > kMaxChannelName || size > kMaxMessage) {
    throw std::runtime_error("log " + path_ + ": a message of " + std::to_string(size) +
                             " bytes on channel \"" + channel + "\" does not fit LCM's limits");
  }
  std::array<std::uint8_t, kHeader> head{};
  PutBigEndian(kSync, 4, &head[0]);
  PutBigEndian(static_cast<std::uint64_t>(count_), 8, &head[4]);
  PutBigEndian(static_cast<std::uint64_t>(utime), 8, &head[12]);
  PutBigEndian(channel.size(), 4, &head[20]);
  PutBigEndian(size, 4, &head[24]);
  if (file_ == nullptr || std::fwrite(head.data(), 1, head.size(), file_) != head.size() ||
      std::fwrite(channel.data(), 1, channel.size(), file_) != channel.size() ||
      std::fwrite(data, 1, size, file_) != size) {
    throw std::runtime_error("cannot write log " + path_ + ": " + std::strerror(errno));
  }
  ++count_;
}

void LogWriter::Close() {
  std::FILE* file = file_;
  file_ = nullptr;
  if (file != nullptr && std::fclose(file) != 0) {
    throw std::runtime_error("cannot finish log " + path_ + ": " + std::strerror(errno));
  }
}

}  // namespace evit
