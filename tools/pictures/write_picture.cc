#include "tools/pictures/write_picture.h"

#include <cstdio>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

namespace evit::pictures {

void WritePicture(const std::string& path, const cv::Mat& picture) {
  const std::string part = path + ".part" + std::filesystem::path(path).extension().string();
  bool written = false;
  try {
    written = cv::imwrite(part, picture);
  } catch (const cv::Exception&) {  // a kind of picture that OpenCV does not know
  }
  if (!written || std::rename(part.c_str(), path.c_str()) != 0) {
    std::remove(part.c_str());
    throw std::runtime_error(path +
                             ": cannot be written; check that the folder exists, is writable and has room, "
                             "and the name ends in .png");
  }
}

}  // namespace evit::pictures
