#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

/// The formats behind LoadMap. Each takes the whole file's bytes, adds every point (finite or not) as it
/// stands, in double, so that survey coordinates keep their millimetres until they are moved, and throws
/// std::runtime_error with what is wrong (the caller adds the file's name).
namespace evit {

using CloudPoints = std::vector<Eigen::Vector3d>;

/// `format` becomes e.g. "PCD ascii". The points are moved by the header's VIEWPOINT, which then is said in
/// `format`.
void ReadPcd(const std::string& bytes, CloudPoints* points, std::string* format);
/// `intensities`: where not null, gets the vertices' "intensity" (0..1), and is empty where there is none.
void ReadPly(const std::string& bytes, CloudPoints* points, std::string* format,
             std::vector<float>* intensities = nullptr);
/// Rows of x y z, more columns ignored; or, where the columns have names, those called x, y and z. A first
/// row of one number (PTS's count) is passed over.
void ReadXyz(const std::string& bytes, CloudPoints* points, std::string* format);

/// The line that begins at `at`, which moves behind its end: LF, CR LF or, where the file's first line ends
/// so, CR alone. False where the line does not end.
bool HeaderLine(const std::string& bytes, std::size_t* at, std::string* line);

/// Decompresses LZF (Marc Lehmann's format, as PCD's binary_compressed uses it). False where the data is
/// damaged or does not give exactly `size` bytes.
bool DecompressLzf(const std::uint8_t* data, std::size_t n, std::uint8_t* out, std::size_t size);

/// Whether a file begins as a PLY does.
bool IsPly(const std::string& bytes);

}  // namespace evit
