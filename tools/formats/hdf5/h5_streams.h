#pragma once

#include "tools/formats/hdf5/h5_file.h"
#include "tools/formats/import/import_log.h"

namespace evit::formats {

/// IMU samples and truth of one file, as far as it holds any, appended. M3ED: `accel`, `omega`, `ts` of a
/// group, and `Cn_T_C0` with `ts`; MVSEC: `imu` (acceleration, angular rate) with `imu_ts`, and `pose` with
/// `pose_ts`.
void ReadH5Streams(const H5File& file, ImportStreams* streams);

}  // namespace evit::formats
