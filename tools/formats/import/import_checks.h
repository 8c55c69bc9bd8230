#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "common/time/utime.h"
#include "tools/formats/import/import_log.h"

namespace evit::formats {

// What every recording is held to, whatever its format. Each throws std::runtime_error naming the file or
// topic and the remedy.

using TimeSpan = std::pair<Utime, Utime>;

/// Samples and poses in order of time; too many that cannot be are an error.
void PutInOrder(ImportStreams* streams);
/// Scales to m/s^2 and rad/s, then refuses what still cannot be.
void CheckUnits(const ImportTarget& target, ImportStreams* streams);

/// Of two stamps that follow each other: a damaged one, or two clocks, leave a hole.
void CheckHole(const std::string& name, Utime before, Utime after);
/// Stamps in the wrong unit would make a log of nothing but silence.
void CheckRate(const std::string& name, std::int64_t n, Utime span);
/// Stamps that were rounded away, as those since 1970 in 32-bit floats.
void RequireDistinctStamps(const std::string& name, std::int64_t n, std::int64_t n_stamps);

/// The IMU, where there is one, has samples without holes and does not end before the events begin.
void CheckImu(const ImportStreams& streams, Utime first_event);
/// Nor does it begin after they end.
void CheckImuBegins(const ImportStreams& streams, Utime first_event, Utime last_event);
/// The truth, of this span, shares some time with the events.
void CheckTruth(const std::string& name, const TimeSpan& truth, Utime first_event, Utime last_event);

}  // namespace evit::formats
