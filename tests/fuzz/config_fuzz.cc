// Rig and settings files, and what settings files are based on. The first byte chooses.
#include <fstream>
#include <stdexcept>
#include <string>

#include "common/config/rig_file.h"
#include "common/config/settings_file.h"
#include "common/config/settings_text.h"
#include "tests/fuzz/choice.h"
#include "tests/fuzz/temporary_file.h"

namespace {

// What loads must also survive being written and read again.
void LoadTwice(const std::string& path) {
  const std::string text = evit::SettingsText(evit::LoadSettings(path).options);
  const evit::fuzz::TemporaryFile again(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  if (evit::SettingsText(evit::LoadOptions(again.path())) != text) __builtin_trap();
}

// A file that starts from the input.
void LoadAsBase(const std::string& path) {
  const std::string text = "base: \"" + path + "\"\nevt { }\n";
  const evit::fuzz::TemporaryFile file(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  evit::LoadSettings(file.path());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  try {
    const evit::fuzz::TemporaryFile file(data + 1, size - 1);
    const int choice = evit::fuzz::Choice(data[0], 3);
    if (choice == 0) evit::LoadRig(file.path());
    if (choice == 1) LoadTwice(file.path());
    if (choice == 2) LoadAsBase(file.path());
  } catch (const std::runtime_error&) {
  }
  return 0;
}
