#include "tools/formats/ros/one_recording.h"

#include <algorithm>
#include <stdexcept>

#include "common/files/decimal_time.h"

namespace evit::formats {
namespace {

constexpr Utime kMaxHole = 2 * kMicrosPerSecond;     // between two parts of one recording
constexpr Utime kMaxOverlap = kMicrosPerSecond / 2;  // of two parts: what was on its way when one was closed

struct FileSpan {
  std::string file;
  TopicSpan span;
  bool cut_off = false;  // the span's end is not that of the file as it was recorded
};

std::vector<FileSpan> FilesWith(const std::vector<BagPart>& parts, const std::string& topic) {
  std::vector<FileSpan> files;
  for (const BagPart& part : parts) {
    const auto found = part.topics.find(topic);
    if (found != part.topics.end()) files.push_back({part.file, found->second, part.cut_off});
  }
  std::sort(files.begin(), files.end(), [](const FileSpan& a, const FileSpan& b) {
    return a.span.begin < b.span.begin || (a.span.begin == b.span.begin && a.file < b.file);
  });
  return files;
}

std::string Text(const FileSpan& file) {
  return file.file + " (" + DecimalSeconds(file.span.begin) + " to " + DecimalSeconds(file.span.end) + " s)";
}

// Two files with the same topic must be parts of one recording.
void RequireSequel(const FileSpan& a, const FileSpan& b, const std::string& topic) {
  const Utime shorter = std::min(a.span.end - a.span.begin, b.span.end - b.span.begin);
  const bool hole = !a.cut_off && b.span.begin - a.span.end > kMaxHole,
             overlap = a.span.end - b.span.begin > std::min(kMaxOverlap, shorter / 2);
  if (!hole && !overlap) return;
  throw std::runtime_error(
      Text(a) + " and " + Text(b) + " both hold " + topic + ", " +
      (hole ? "with a hole between them" : "at the same time") +
      ": these are different recordings; import each by itself: evit import FILE --out LOG");
}

}  // namespace

void RequireOneRecording(const std::vector<BagPart>& parts, const TakenTopics& taken) {
  if (parts.size() < 2) return;
  for (const std::string& topic : {taken.events, taken.imu, taken.truth}) {
    const std::vector<FileSpan> files = FilesWith(parts, topic);
    for (std::size_t k = 1; k < files.size(); ++k) RequireSequel(files[k - 1], files[k], topic);
  }
  const std::vector<FileSpan> events = FilesWith(parts, taken.events);
  if (events.empty()) return;
  const TopicSpan all{events.front().span.begin, events.back().span.end};
  for (const std::string& topic : {taken.imu, taken.truth}) {
    for (const FileSpan& file : FilesWith(parts, topic)) {
      if (file.span.begin <= all.end + kMaxHole && file.span.end >= all.begin - kMaxHole) continue;
      throw std::runtime_error(
          Text(file) + " holds " + topic + " of another time than the events of " +
          Text({events.front().file, all}) +
          ": these are different recordings, or clocks; import the files of one, or give an IMU "
          "of another clock with --imu FILE --imu-offset SECONDS");
    }
  }
}

}  // namespace evit::formats
