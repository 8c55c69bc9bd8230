#pragma once

#include <vector>

#include "common/files/decimal_time.h"
#include "common/time/utime.h"
#include "tools/formats/hdf5/h5_file.h"
#include "tools/formats/import/counter_wrap.h"

namespace evit::formats {

/// Stamps of events in HDF5 to microseconds: whole numbers or floats of any unit; counters that wrap are
/// continued before `t_offset` is added.
class H5Stamps {
 public:
  /// `offset`: t_offset's dataset, or null. Throws std::runtime_error where it is not one time.
  H5Stamps(TimeUnit unit, const H5Rows* offset);

  /// One stamp of a float; kNoTime where it is none.
  Utime FromDouble(double value);
  /// The same of whole numbers, in place.
  void FromIntegers(std::vector<Utime>* stamps);

  static constexpr Utime kNoTime = INT64_MAX;

 private:
  Utime Finish(Utime micros) { return wrap_.Continue(micros) + offset_; }

  double micros_;  // per unit
  TimeUnit unit_;
  Utime offset_ = 0;
  CounterWrap wrap_;
};

}  // namespace evit::formats
