#pragma once

namespace evit::formats {

/// HDF5 filter 32000 (LZF), which h5py writes with compression="lzf" and only h5py brings along. For reading.
/// Call before opening a file; calling again does nothing. Throws std::runtime_error where HDF5 refuses it.
void RegisterLzfFilter();

inline constexpr int kLzfFilter = 32000;

}  // namespace evit::formats
