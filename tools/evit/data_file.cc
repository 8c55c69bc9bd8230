#include "tools/evit/data_file.h"

#include <filesystem>
#include <stdexcept>

namespace evit::commands {

std::string DataFile(const std::string& name) {
  namespace fs = std::filesystem;
  const fs::path program = fs::read_symlink("/proc/self/exe");
  const fs::path path = program.parent_path().parent_path() / "share" / "evit" / name;
  std::error_code error;
  const fs::path found = fs::canonical(path, error);
  if (error)
    throw std::runtime_error(path.string() + ": " + error.message() + "; it belongs to EVIT's installation");
  return found.string();
}

}  // namespace evit::commands
