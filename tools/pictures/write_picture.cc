#include "tools/pictures/write_picture.h"

#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

#include "common/files/staged_file.h"

namespace evit::pictures {

void WritePicture(const std::string& path, const cv::Mat& picture) {
  StagedFile file(path, StagedFile::Name::kPartExtension);
  bool written = false;
  try {
    written = cv::imwrite(file.part(), picture);
  } catch (const cv::Exception&) {  // a kind of picture that OpenCV does not know
  }
  if (!written) {
    throw std::runtime_error(path +
                             ": cannot be written; check that the folder exists, is writable and has room, "
                             "and the name ends in .png");
  }
  file.Commit();
}

}  // namespace evit::pictures
