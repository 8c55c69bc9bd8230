#include "tools/formats/prophesee/evt3_writer.h"

#include <stdexcept>

namespace evit::formats {
namespace {

enum Type : unsigned { kAddrY = 0x0, kAddrX = 0x2, kTimeLow = 0x6, kTimeHigh = 0x8 };

constexpr unsigned kMaxCoordinate = 2047;

}  // namespace

Evt3Writer::Evt3Writer(const std::string& path, int width, int height, Utime start)
    : path_(path), file_(path), start_(start) {
  file_.stream() << "% evt 3.0\n% format EVT3;height=" << height << ";width=" << width << "\n% geometry "
                 << width << "x" << height << "\n% endianness little\n% integrator_name EVIT\n% end\n";
}

// Each step of the upper part is said, as sensors do: readers count them to know how often it has wrapped.
void Evt3Writer::PutTime(Utime t) {
  if (stamped_ && t == last_) return;
  for (Utime high = stamped_ ? (last_ >> 12) + 1 : 0; high <= t >> 12; ++high)
    Put(kTimeHigh, static_cast<unsigned>(high & 0xFFF));
  Put(kTimeLow, static_cast<unsigned>(t & 0xFFF));
  last_ = t;
  stamped_ = true;
}

void Evt3Writer::Append(const EventArray& events) {
  for (std::size_t k = 0; k < events.size(); ++k) {
    const Utime t = events.t[k] - start_;
    if (t < last_ || events.x[k] > kMaxCoordinate || events.y[k] > kMaxCoordinate) {
      throw std::runtime_error(
          path_ +
          ": an event is earlier than the one before, or lies beyond pixel 2047, the limit of EVT 3.0");
    }
    PutTime(t);
    if (events.y[k] != y_) {
      y_ = events.y[k];
      Put(kAddrY, static_cast<unsigned>(y_));
    }
    Put(kAddrX, static_cast<unsigned>(events.p[k] != 0 ? 0x800 : 0) | events.x[k]);
  }
  file_.stream().write(reinterpret_cast<const char*>(words_.data()),
                       static_cast<std::streamsize>(2 * words_.size()));
  words_.clear();
}

void Evt3Writer::Close() { file_.Commit(); }

}  // namespace evit::formats
