#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/map/point_map.h"

/// The formats behind LoadMap. Each takes the whole file's bytes, adds every point (finite or not) and throws
/// std::runtime_error with what is wrong (the caller adds the file's name).
namespace evit {

/// `format` becomes e.g. "PCD ascii".
void ReadPcd(const std::string& bytes, std::vector<Eigen::Vector3f>* points, std::string* format);
/// `intensities`: where not null, gets the vertices' "intensity" (0..1), and is empty where there is none.
void ReadPly(const std::string& bytes, std::vector<Eigen::Vector3f>* points, std::string* format,
             std::vector<float>* intensities = nullptr);
void ReadXyz(const std::string& bytes, std::vector<Eigen::Vector3f>* points, std::string* format);

/// Decompresses LZF (Marc Lehmann's format, as PCD's binary_compressed uses it). False where the data is
/// damaged or does not give exactly `size` bytes.
bool DecompressLzf(const std::uint8_t* data, std::size_t n, std::uint8_t* out, std::size_t size);

/// Three numbers at the start of a line's words; false where there are fewer or one is no number ("nan" is
/// one).
bool ParseThree(const std::string& line, float* xyz);

}  // namespace evit
