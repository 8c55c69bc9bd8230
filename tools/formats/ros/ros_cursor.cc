#include "tools/formats/ros/ros_cursor.h"

#include <stdexcept>

namespace evit::formats {
namespace {

constexpr std::size_t kEncapsulation = 4;  // bytes in front of CDR; numbers are aligned from behind it

}  // namespace

RosCursor::RosCursor(const std::uint8_t* data, std::size_t size, bool cdr)
    : data_(data), size_(size), cdr_(cdr) {
  if (!cdr) return;
  const std::uint8_t* how = Take(kEncapsulation, "encapsulation");
  if (how[0] != 0 || how[1] > 1)
    throw std::runtime_error("the message is serialized in a way that is not read (encapsulation " +
                             std::to_string(how[0] << 8 | how[1]) +
                             "; plain CDR is 0 or 1); record it with a middleware's default settings");
  big_endian_ = how[1] == 0;
}

const std::uint8_t* RosCursor::Take(std::size_t n, const char* field) {
  if (n > left()) {
    throw std::runtime_error(std::string(field) + " needs " + std::to_string(n) + " bytes, the message has " +
                             std::to_string(left()) + " left; the bag is damaged or its type is another one");
  }
  at_ += n;
  return data_ + at_ - n;
}

void RosCursor::Align(std::size_t n, const char* field) {
  const std::size_t rest = (at_ - kEncapsulation) % n;
  if (rest != 0) Take(n - rest, field);
}

void RosCursor::Doubles(int n, double* out, const char* field) {
  for (int k = 0; k < n; ++k) out[k] = Get<double>(field);
}

void RosCursor::SkipDoubles(int n, const char* field) {
  for (int k = 0; k < n; ++k) Get<double>(field);
}

Utime RosCursor::Time(const char* field) {
  const auto seconds = Get<std::int32_t>(field);
  const auto nanoseconds = Get<std::uint32_t>(field);
  return (cdr_ ? Utime{seconds} : Utime{static_cast<std::uint32_t>(seconds)}) * kMicrosPerSecond +
         (Utime{nanoseconds} + 500) / 1000;
}

std::string RosCursor::Text(const char* field) {
  const auto n = Get<std::uint32_t>(field);
  const auto* text = reinterpret_cast<const char*>(Take(n, field));
  return {text, strnlen(text, n)};  // CDR counts the zero at the end
}

Utime RosCursor::Header(std::string* frame) {
  if (!cdr_) Get<std::uint32_t>("header.seq");
  const Utime stamp = Time("header.stamp");
  const std::string id = Text("header.frame_id");
  if (frame != nullptr) *frame = id;
  return stamp;
}

}  // namespace evit::formats
