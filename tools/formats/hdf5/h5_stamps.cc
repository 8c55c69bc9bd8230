#include "tools/formats/hdf5/h5_stamps.h"

#include <cmath>

#include "tools/formats/import/latest_time.h"
#include "tools/formats/import/micros_per_unit.h"

namespace evit::formats {
namespace {

// t_offset has the unit of the stamps, unless it is a date in another.
Utime ReadOffset(const H5Rows& rows, double micros) {
  if (rows.rows() != 1 || rows.columns() != 1)
    rows.Fail("holds " + std::to_string(rows.rows() * rows.columns()) + " numbers; expected one (us)");
  if (rows.is_integer()) {
    const std::int64_t value = rows.ReadAll<std::int64_t>().front();
    const double size = std::abs(static_cast<double>(value));
    if (size >= 1e17) return value / 1000;
    if (size >= 1e14 || micros == 1) return value;
  }
  const double value = rows.ReadAll<double>().front(), size = std::abs(value);
  double scale = micros;
  if (size >= 1e14) scale = size >= 1e17 ? 1e-3 : 1;  // dates in us or ns
  if (size >= 1e9 && size < 1e10) scale = 1e6;        // in s
  if (!(size * scale < kLatestTime)) rows.Fail("is not a time");
  return std::llround(value * scale);
}

}  // namespace

H5Stamps::H5Stamps(TimeUnit unit, const H5Rows* offset) : micros_(MicrosPerUnit(unit)), unit_(unit) {
  if (offset != nullptr) offset_ = ReadOffset(*offset, micros_);
}

Utime H5Stamps::FromDouble(double value) {
  const double micros = value * micros_;
  return std::abs(micros) < kLatestTime ? Finish(std::llround(micros)) : kNoTime;  // NaN is not a time either
}

void H5Stamps::FromIntegers(std::vector<Utime>* stamps) {
  constexpr std::int64_t kThousand = 1000;
  for (Utime& t : *stamps) {
    if (unit_ == TimeUnit::kNanoseconds) {
      t = t / kThousand;
    } else if (unit_ != TimeUnit::kMicroseconds) {
      t = std::abs(static_cast<double>(t)) * micros_ < kLatestTime ? t * static_cast<Utime>(micros_)
                                                                   : kNoTime;
    }
    t = t < -kLatestTime || t > kLatestTime ? kNoTime : Finish(t);
  }
}

}  // namespace evit::formats
