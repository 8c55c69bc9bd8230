#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tools/formats/frames/file_tree.h"
#include "tools/formats/frames/frame_source.h"
#include "tools/formats/frames/picture_list.h"

namespace evit::formats {

/// The pictures of one folder, in a folder or a zip archive, as OpenFrames describes them.
class FileFrames : public FrameSource {
 public:
  /// `path`: of the tree. `depth`: the depth images are meant where there are others.
  FileFrames(std::unique_ptr<FileTree> tree, const std::string& path, bool depth);

  StoredPicture Fetch(std::size_t k) override;

 private:
  bool TakeList(const std::string& name, const PictureFolder& pictures);
  void Add(const std::string& file, const std::string& stamp);

  std::unique_ptr<FileTree> tree_;
  std::vector<std::string> files_;  // of each frame, in the tree
};

}  // namespace evit::formats
