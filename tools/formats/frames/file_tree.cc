#include "tools/formats/frames/file_tree.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "tools/formats/frames/zip_tree.h"

namespace evit::formats {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxFile = 1U << 28;  // bytes; no picture is as large

class FolderTree : public FileTree {
 public:
  explicit FolderTree(const std::string& path) : root_(path) {
    std::error_code error;
    for (auto at = fs::recursive_directory_iterator(root_, fs::directory_options::skip_permission_denied);
         at != fs::recursive_directory_iterator(); ++at) {
      if (at.depth() >= 1) at.disable_recursion_pending();
      const std::string name = at->path().lexically_relative(root_).generic_string();
      if (at->is_regular_file(error) && at->path().filename().string()[0] != '.') names_.push_back(name);
    }
    std::sort(names_.begin(), names_.end());
  }

  const std::vector<std::string>& names() const override { return names_; }
  bool Has(const std::string& name) const override { return fs::is_regular_file(root_ / name); }
  std::string PathOf(const std::string& name) const override {
    return (root_ / name).lexically_normal().string();
  }
  std::vector<std::uint8_t> Read(const std::string& name) override {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(root_ / name, error);
    std::ifstream file(root_ / name, std::ios::binary);
    if (error || !file) throw std::runtime_error(PathOf(name) + ": cannot be read");
    if (size > kMaxFile) throw std::runtime_error(PathOf(name) + ": is too large for a picture");
    std::vector<std::uint8_t> bytes(size);
    file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
    if (static_cast<std::uintmax_t>(file.gcount()) != size)
      throw std::runtime_error(PathOf(name) + ": cannot be read to its end");
    return bytes;
  }

 private:
  fs::path root_;
  std::vector<std::string> names_;
};

}  // namespace

std::unique_ptr<FileTree> OpenFileTree(const std::string& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) return std::make_unique<FolderTree>(path);
  if (!fs::exists(path, error)) throw std::runtime_error(path + ": there is no such folder or file");
  if (ZipTree::Recognises(path)) return std::make_unique<ZipTree>(path);
  throw std::runtime_error(path +
                           ": is neither a folder with pictures nor a zip archive nor a bag of ROS; unpack "
                           "other archives (tar -xf) and name the folder");
}

}  // namespace evit::formats
