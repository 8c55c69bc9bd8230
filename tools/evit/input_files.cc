#include "tools/evit/input_files.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace evit::commands {
namespace {

namespace fs = std::filesystem;
using std::string_view_literals::operator""sv;

constexpr std::size_t kLooked = 1 << 16;  // bytes

struct Magic {
  std::string_view begin;
  Contents contents;
};
constexpr Magic kMagics[] = {
    {"\xed\xa1\xda\x01"sv, Contents::kLog},  {"# .PCD"sv, Contents::kCloud},
    {"VERSION .7"sv, Contents::kCloud},      {"VERSION 0.7"sv, Contents::kCloud},
    {"ply\n"sv, Contents::kCloud},           {"ply\r"sv, Contents::kCloud},
    {"\x89PNG"sv, Contents::kForeign},       {"\xff\xd8\xff"sv, Contents::kForeign},
    {"\x89HDF"sv, Contents::kForeign},       {"#ROSBAG"sv, Contents::kForeign},
    {"PK\x03\x04"sv, Contents::kForeign},    {"\x1f\x8b"sv, Contents::kForeign},
    {"SQLite format"sv, Contents::kForeign}, {"\x89MCAP"sv, Contents::kForeign},
    {"#!AER-DAT"sv, Contents::kForeign},     {"% evt "sv, Contents::kForeign},
    {"% Data file"sv, Contents::kForeign},   {"%PDF"sv, Contents::kForeign},
};

// What an option takes; the words go after "expected".
struct Input {
  const char* option;
  Contents contents;
  const char* expected;
};
constexpr Input kInputs[] = {
    {"--log", Contents::kLog, "an LCM log, as evit import writes it"},
    {"LOG", Contents::kLog, "an LCM log, as evit import writes it"},
    {"log", Contents::kLog, "an LCM log, as evit run --record writes it"},
    {"--from", Contents::kLog, "an LCM log, as evit import writes it"},
    {"--events", Contents::kLog, "an LCM log, as evit import writes it"},
    {"--upright", Contents::kLog, "an LCM log with IMU, as evit import writes it"},
    {"--map", Contents::kCloud, "a map: PCD, PLY or text"},
    {"--photometric-map", Contents::kCloud, "a photometric map, as evit map photometric writes it"},
    {"MAP", Contents::kCloud, "a map: PCD, PLY or text"},
    {"REFERENCE", Contents::kCloud, "a map: PCD, PLY or text"},
    {"IN", Contents::kCloud, "a map: PCD, PLY or text"},
    {"FILE", Contents::kCloud, "a map: PCD, PLY or text"},
    {"--rig", Contents::kRig, "a rig file (docs/reference/configuration.md), or Kalibr's camchain"},
    {"--camera", Contents::kRig, "a file with the `camera` block of a rig file"},
    {"--depth-camera", Contents::kRig, "a file with the `camera` block of a rig file"},
    {"--camera-of", Contents::kRig, "a rig file, or Kalibr's camchain"},
    {"--config", Contents::kSettings, "a settings file, as config/tracker.textproto"},
    {"--truth", Contents::kTable, "poses: TUM's t x y z qx qy qz qw, or a table with a head"},
    {"--estimate", Contents::kTable, "poses: TUM's t x y z qx qy qz qw, as trajectory.tum of evit run"},
    {"--initial-from", Contents::kTable, "poses: TUM's t x y z qx qy qz qw, or a table with a head"},
    {"--poses", Contents::kTable, "poses: TUM's t x y z qx qy qz qw, or a table with a head"},
    {"--covariance", Contents::kTable, "covariance.csv of evit run"},
};

const Input* Find(const std::string& option) {
  const auto* found = std::find_if(std::begin(kInputs), std::end(kInputs),
                                   [&](const Input& i) { return option == i.option; });
  return found == std::end(kInputs) ? nullptr : found;
}

const char* NameOf(Contents contents) {
  switch (contents) {
    case Contents::kLog:
      return "an LCM log";
    case Contents::kCloud:
      return "a point cloud";
    case Contents::kRig:
      return "a rig file";
    case Contents::kSettings:
      return "a settings file";
    case Contents::kTable:
      return "a table of numbers";
    case Contents::kForeign:
      return "of another kind (a recording, a picture or an archive)";
    case Contents::kBinary:
      return "a binary file";
    case Contents::kOther:
      break;
  }
  return "something else";
}

bool IsNumber(const std::string& word) {
  char* end = nullptr;
  std::strtod(word.c_str(), &end);
  return !word.empty() && *end == '\0';
}

// Of text: rig and settings files are recognised by their blocks, tables by numbers.
Contents ContentsOfText(const std::string& text) {
  std::istringstream lines(text);
  int n_rows = 0, n_others = 0;
  for (std::string line; std::getline(lines, line);) {
    std::replace_if(
        line.begin(), line.end(), [](char c) { return c == ',' || c == '{' || c == ';'; }, ' ');
    std::istringstream in(line);
    const std::vector<std::string> words{std::istream_iterator<std::string>(in), {}};
    if (words.empty() || words[0][0] == '#') continue;
    if (words[0] == "camera" || words[0] == "cam0:") return Contents::kRig;
    if (words[0] == "evit" || words[0] == "evt" || words[0] == "evpt") return Contents::kSettings;
    ++(words.size() >= 3 && std::all_of(words.begin(), words.end(), IsNumber) ? n_rows : n_others);
  }
  // A table may have a header; a list of numbers in another file is none.
  return n_rows > 0 && n_others <= 1 ? Contents::kTable : Contents::kOther;
}

// Text may be a map, and a table may be anything that is made of numbers. What is binary may be a damaged log
// or a map with an odd head, of which their readers say more.
bool Fits(Contents wanted, Contents found) {
  if (found == Contents::kBinary) return wanted == Contents::kLog || wanted == Contents::kCloud;
  return found == wanted || found == Contents::kOther ||
         (wanted == Contents::kCloud && found == Contents::kTable);
}

// Up to three files of a folder that could be meant, one of which a name ending in .tum tells of tables.
std::string Candidates(const std::string& folder, Contents wanted) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator file(folder, error), end; !error && file != end; file.increment(error)) {
    if (names.size() < 100 && file->is_regular_file(error)) names.push_back(file->path().string());
  }
  std::sort(names.begin(), names.end());
  std::string text;
  int n = 0;
  for (const std::string& name : names) {
    if (wanted == Contents::kTable && fs::path(name).extension() != ".tum") continue;
    if (n == 3 || ContentsOf(name) != wanted) continue;
    text.append(n++ == 0 ? ": " : " or ").append(name);
  }
  return text;
}

void RequireReadable(const std::string& what, const std::string& path) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (file) return;
  const int why = errno;
  throw std::runtime_error(what + ": cannot be read (" + std::strerror(why) + ")" +
                           (why == EACCES ? "; change its permissions (chmod u+r), or copy it" : ""));
}

// Of numbers: CLI11 takes nothing for 0, and lets what is below zero wrap around.
std::string NotANumber(const std::string& text) {
  return text.empty() ? "the value is empty; give a number" : "";
}
std::string Negative(const std::string& text) {
  return text.rfind('-', 0) == 0 ? "'" + text + "' is not a whole number from 0 on" : "";
}
std::string NotFinite(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  return end != text.c_str() && *end == '\0' && !std::isfinite(value)
             ? "'" + text + "' is not a finite number"
             : "";
}

// `evit import` and what is below it, not `evit map import`.
bool IsImport(const CLI::App* command) {
  for (; command->get_parent() != nullptr; command = command->get_parent())
    if (command->get_name() == "import" && command->get_parent()->get_parent() == nullptr) return true;
  return false;
}

// CLI11 looks at the values of options before it gives the help that was asked for.
bool AsksForHelp(const CLI::App* command) {
  const CLI::Option* help = command->get_help_ptr();
  return help != nullptr && help->count() > 0;
}

}  // namespace

Contents ContentsOf(const std::string& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return Contents::kOther;
  std::ifstream file(path, std::ios::binary);
  std::string text(kLooked, '\0');
  file.read(text.data(), kLooked);
  text.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, file.gcount())));
  for (const Magic& magic : kMagics) {
    if (text.compare(0, magic.begin.size(), magic.begin) == 0) return magic.contents;
  }
  return text.find('\0') == std::string::npos ? ContentsOfText(text) : Contents::kBinary;
}

void RequireInput(const std::string& option, const std::string& path) {
  const Input* input = Find(option);
  if (input == nullptr || path.empty()) return;
  const std::string what = option + " " + path, expected = std::string("; expected ") + input->expected;
  std::error_code error;
  if (!fs::exists(path, error)) {
    const std::string why = error ? error.message() : "";
    throw std::runtime_error(
        what + (why.empty() ? ": there is no such file" : ": cannot be read (" + why + ")") +
        (fs::path(path).is_relative() ? ", looked for in " + fs::current_path(error).string() : "") +
        expected);
  }
  if (fs::is_directory(path, error))
    throw std::runtime_error(what + ": is a folder; give the file in it" + Candidates(path, input->contents) +
                             expected);
  if (!fs::is_regular_file(path, error)) return;
  RequireReadable(what, path);
  // Settings that leave everything as it is may be empty.
  if (fs::file_size(path, error) == 0 && !error && input->contents != Contents::kSettings)
    throw std::runtime_error(what + ": is empty; copy or make it again" + expected);
  const Contents found = ContentsOf(path);
  if (!Fits(input->contents, found)) throw std::runtime_error(what + ": is " + NameOf(found) + expected);
}

void CheckInputs(CLI::App* app) {
  for (CLI::App* command : app->get_subcommands([](CLI::App*) { return true; })) CheckInputs(command);
  const bool files = !IsImport(app), settings = app->get_name() != "paper";
  for (CLI::Option* option : app->get_options()) {
    const std::string name = option->get_name();
    const std::string type = option->get_type_name().substr(0, option->get_type_name().find(':'));
    if (type == "FLOAT" || type == "INT" || type == "UINT") option->check(NotANumber);
    if (type == "FLOAT") option->check(NotFinite);
    if (type == "UINT") option->check(Negative);
    if (!files || Find(name) == nullptr || (name == "--config" && !settings)) continue;
    const bool required = option->get_required();
    option->check([name, required, app](const std::string& path) {
      if (AsksForHelp(app)) return std::string();
      if (path.empty() && required)
        throw std::runtime_error(std::string(name).append(": the name is empty; give a file"));
      RequireInput(name, path);
      return std::string();
    });
  }
}

}  // namespace evit::commands
