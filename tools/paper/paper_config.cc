#include "tools/paper/paper_config.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "common/config/config_error.h"
#include "common/config/settings_file.h"
#include "common/config/settings_text.h"
#include "common/config/text_file.h"

namespace evit::paper {
namespace {

void Require(bool condition, const std::string& path, const std::string& what) {
  if (!condition) throw ConfigError(path + ": " + what);
}

bool IsFileName(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-';
  });
}

std::string Beside(const std::string& file, const std::string& path) {
  return (std::filesystem::absolute(file).parent_path() / path).lexically_normal().string();
}

bool Same(const paper::Method& a, const paper::Method& b) {
  return a.config() == b.config() && a.has_fixed_rate_hz() == b.has_fixed_rate_hz() &&
         a.fixed_rate_hz() == b.fixed_rate_hz() && a.has_motion_model() == b.has_motion_model() &&
         a.motion_model() == b.motion_model();
}

template <typename Methods>
void CheckMethods(const std::string& path, const Methods& methods, const std::string& field) {
  std::set<std::string> ids;
  for (const paper::Method& m : methods) {
    Require(IsFileName(m.id()), path,
            field + ".id: \"" + m.id() + "\" is not a file name: use letters, digits, _ and -");
    Require(ids.insert(m.id()).second, path, field + ".id: \"" + m.id() + "\" is there twice");
  }
}

void CheckSequence(const std::string& path, const paper::Sequence& s) {
  const std::string where = "sequence " + s.name() + ": ";
  Require(IsFileName(s.name()), path,
          "sequence.name: \"" + s.name() + "\" is not a file name: use letters, digits, _ and -");
  Require(s.has_begin_s() == s.has_end_s(), path,
          where + "begin_s and end_s: give both, or none (the whole sequence)");
  Require(!s.has_begin_s() || (s.begin_s() >= 0 && s.end_s() > s.begin_s()), path,
          where + "begin_s, end_s: 0 <= begin_s < end_s is expected");
  Require(s.t_map_world_size() == 0 || s.t_map_world_size() == 16, path,
          where + "T_map_world: 16 numbers are expected (4x4, row-major), got " +
              std::to_string(s.t_map_world_size()));
}

}  // namespace

paper::Paper LoadPaper(const std::string& path) {
  paper::Paper config;
  ParseTextFile(path, &config);
  Require(config.method_size() > 0 && config.sequence_size() > 0, path,
          "at least one method and one sequence are expected");
  config.set_rig(Beside(path, config.rig()));
  for (paper::Method& m : *config.mutable_method()) m.set_config(Beside(path, m.config()));
  for (paper::Method& m : *config.mutable_motion_model()) m.set_config(Beside(path, m.config()));
  CheckMethods(path, config.method(), "method");
  CheckMethods(path, config.motion_model(), "motion_model");
  for (const paper::Method& a : config.method()) {
    for (const paper::Method& b : config.motion_model()) {
      Require(a.id() != b.id() || Same(a, b), path,
              "motion_model " + b.id() + ": differs from the method of that id; give it another");
    }
  }
  std::set<std::string> names;
  for (const paper::Sequence& s : config.sequence()) {
    CheckSequence(path, s);
    Require(names.insert(s.name()).second, path, "sequence " + s.name() + ": is there twice");
  }
  Require(names.count(config.figure_sequence()) == 1, path,
          "figure_sequence: there is no sequence \"" + config.figure_sequence() + "\"");
  const auto methods = AllMethods(config);
  Require(std::any_of(methods.begin(), methods.end(),
                      [&](const paper::Method& m) { return m.id() == config.figure_method(); }),
          path, "figure_method: there is no method \"" + config.figure_method() + "\"");
  return config;
}

std::vector<paper::Method> AllMethods(const paper::Paper& config) {
  std::vector<paper::Method> all(config.method().begin(), config.method().end());
  for (const paper::Method& m : config.motion_model()) {
    const bool known = std::any_of(all.begin(), all.end(), [&](const auto& a) { return a.id() == m.id(); });
    if (!known) all.push_back(m);
  }
  return all;
}

bool IsPhotometric(const paper::Method& method) {
  return LoadOptions(method.config()).method == PipelineOptions::Method::kEvpt;
}

std::string TrackerText(const paper::Method& method) {
  PipelineOptions options = LoadOptions(method.config());
  if (method.has_fixed_rate_hz()) options.keyframes.fixed_rate_hz = method.fixed_rate_hz();
  if (method.has_motion_model()) {
    Require(options.method == PipelineOptions::Method::kEvit, method.config(),
            "method " + method.id() + " has a motion_model: that is for settings of evit { }");
    options.window.motion_model = static_cast<WindowOptions::MotionModel>(method.motion_model());
  }
  return SettingsText(options);
}

}  // namespace evit::paper
