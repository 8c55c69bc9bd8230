#pragma once

#include <opencv2/core.hpp>
#include <string>

namespace evit::pictures {

/// Writes a picture, of the kind its name ends with, whole or not at all. Throws std::runtime_error naming
/// the file.
void WritePicture(const std::string& path, const cv::Mat& picture);

}  // namespace evit::pictures
