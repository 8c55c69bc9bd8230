#include "procman/process_output.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace evit::procman {

namespace {

constexpr std::size_t kKept = 4096;  // bytes of output kept
constexpr int kOutputPerRead =
    1 << 18;  // bytes: a command that never stops printing must not block the others

}  // namespace

ProcessOutput::ProcessOutput(const std::string& log) {
  if (log.empty()) return;
  log_ = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0644);
  if (log_ < 0) throw std::runtime_error(log + ": cannot be written: " + std::strerror(errno));
}

ProcessOutput::~ProcessOutput() {
  Close();
  if (log_ >= 0) close(log_);
}

void ProcessOutput::Open(int read_end) { read_end_ = read_end; }

void ProcessOutput::Close() {
  if (read_end_ >= 0) close(read_end_);
  read_end_ = -1;
}

void ProcessOutput::Read(const Sink& sink) {
  std::array<char, 16384> buffer{};
  for (int taken = 0; taken < kOutputPerRead;) {
    const ssize_t n = read(read_end_, buffer.data(), buffer.size());
    if (n <= 0) return;
    taken += static_cast<int>(n);
    const std::string text(buffer.data(), static_cast<std::size_t>(n));
    // A full disk must not stop the command: only the copy of this output in the file is lost.
    if (log_ >= 0 && write(log_, text.data(), text.size()) < 0) errno = 0;
    last_ += text;
    if (last_.size() > kKept) last_.erase(0, last_.size() - kKept);
    sink(text);
  }
}

std::string ProcessOutput::LastLines(int lines) const {
  std::string words = last_;
  while (!words.empty() && words.back() == '\n') words.pop_back();
  std::size_t begin = words.size();
  for (; lines > 0 && begin != std::string::npos && begin > 0; --lines) begin = words.rfind('\n', begin - 1);
  words.erase(0, begin == std::string::npos || begin == 0 ? 0 : begin + 1);
  if (words.empty()) return "";
  std::string text;
  for (std::size_t at = 0; at <= words.size();) {
    const std::size_t end = std::min(words.find('\n', at), words.size());
    text += "\n  " + words.substr(at, end - at);
    at = end + 1;
  }
  return text;
}

}  // namespace evit::procman
