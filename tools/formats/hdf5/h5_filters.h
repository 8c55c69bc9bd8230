#pragma once

#include <string>

namespace evit::formats {

/// Makes HDF5 able to decompress what event recordings are compressed with: Zstandard (32015), Blosc (32001),
/// LZF (32000) and LZ4 (32004); deflate it knows itself, others it loads as plug-ins where they are
/// installed. Once is enough.
void RegisterFilters();

/// What a filter is, by its number, and how to get it where it is missing.
std::string FilterRemedy(int filter);

}  // namespace evit::formats
