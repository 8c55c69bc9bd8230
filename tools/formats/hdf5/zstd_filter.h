#pragma once

namespace evit::formats {

/// HDF5 filter 32015 (Zstandard), which VECtor's and DSEC's files are compressed with. Debian's HDF5 has no
/// plug-in for it, so it is registered in process. Call before opening or making a file; calling again does
/// nothing. Throws std::runtime_error where HDF5 refuses it.
void RegisterZstdFilter();

inline constexpr int kZstdFilter = 32015;

}  // namespace evit::formats
