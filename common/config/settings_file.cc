#include "common/config/settings_file.h"

#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "common/config/config_error.h"
#include "common/config/field_options.pb.h"
#include "common/config/field_rules.h"
#include "common/config/option_table.h"
#include "common/config/settings.pb.h"
#include "common/config/text_file.h"

namespace evit {
namespace {

using google::protobuf::FieldDescriptor;

constexpr std::size_t kMostFiles = 8;  // based on each other

constexpr const char* kMethods[] = {"evit", "evt", "evpt"};  // as PipelineOptions::Method

// The method a path belongs to; -1: to all.
int MethodOf(const std::string& path) {
  const std::string first = path.substr(0, path.find('.'));
  const auto* const found = std::find(std::begin(kMethods), std::end(kMethods), first);
  return found == std::end(kMethods) ? -1 : static_cast<int>(found - std::begin(kMethods));
}

// The paths where a key of the file stands today; none for a group of the earlier layout, or a key that has
// no effect any more.
std::vector<std::string> PathsNow(const Setting& s) {
  const auto* root = config::Settings::descriptor();
  // `method` names the group that is to be there.
  if (s.path == "method") {
    return {
        s.field->options().GetExtension(config::moved_to, static_cast<int>(std::get<std::int64_t>(s.value)))};
  }
  const auto& own = s.field->options().GetRepeatedExtension(config::moved_to);
  if (!own.empty()) {
    if (s.field->message_type() != nullptr) return {};
    return {own.begin(), own.end()};
  }
  if (s.field->options().deprecated()) return {};
  const std::size_t dot = s.path.find('.');
  const FieldDescriptor* group = FindField(root, s.path.substr(0, dot));
  if (!group->options().deprecated()) return {s.path};
  if (dot == std::string::npos) return {};
  return {group->options().GetExtension(config::moved_to, 0) + s.path.substr(dot)};
}

// What one file sets, at today's places.
std::vector<Setting> ReadOne(const std::string& path, std::vector<std::string>* notes) {
  config::Settings message;
  std::vector<Setting> out;
  for (const Setting& s : ParseTextFile(path, &message)) {
    const std::vector<std::string> paths = PathsNow(s);
    for (const std::string& now : paths) {
      Setting moved = s;
      moved.path = now;
      moved.field = FindField(config::Settings::descriptor(), now);
      if (moved.field->message_type() != nullptr) moved.value = {};
      out.push_back(std::move(moved));
    }
    if (s.field->options().HasExtension(config::removed)) {
      if (s.value != SettingValue(false)) {
        throw ConfigError(s.Place() + ": " + s.path + ": was removed; " +
                          s.field->options().GetExtension(config::removed));
      }
      notes->push_back(s.Place() + ": " + s.path + " has no effect any more");
    }
    if (!paths.empty() && paths.front() != s.path) {
      notes->push_back(
          s.Place() + ": " + s.path + " is now " +
          (paths.front().find('.') == std::string::npos ? paths.front() + " { }" : paths.front()));
    }
  }
  return out;
}

// `chain`: the files that led here, this one last.
void ReadChain(const std::vector<std::string>& chain, std::vector<Setting>* settings,
               std::vector<std::string>* notes) {
  const std::vector<Setting> own = ReadOne(chain.back(), notes);
  for (const Setting& s : own) {
    if (s.path != "base") continue;
    const std::filesystem::path file(chain.back());
    const std::string base =
        (file.parent_path() / std::get<std::string>(s.value)).lexically_normal().string();
    std::string words = s.Place() + ": base: ";
    if (!std::filesystem::is_regular_file(base)) {
      throw ConfigError(words + base + " cannot be read; give a settings file, as a path beside this file");
    }
    const bool again = std::any_of(chain.begin(), chain.end(), [&](const std::string& earlier) {
      return std::filesystem::equivalent(earlier, base);
    });
    if (again || chain.size() >= kMostFiles) {
      words += again ? "files are based on each other: " : "more than 8 files are based on each other: ";
      for (const std::string& earlier : chain) words += earlier + " -> ";
      throw ConfigError(words + base);
    }
    std::vector<std::string> longer = chain;
    longer.push_back(base);
    ReadChain(longer, settings, notes);
  }
  settings->insert(settings->end(), own.begin(), own.end());
}

// How a value is called in an error: "surface.min_decay_ms (evt.textproto:3)".
std::string Named(const LoadedSettings& loaded, const std::string& path) {
  const auto found = loaded.set.find(path);
  return path + " = " + NumberText(std::get<double>(GetOption(loaded.options, path))) +
         (found == loaded.set.end() ? " (default)" : " (" + found->second.Place() + ")");
}

void CheckOrder(const std::string& file, const LoadedSettings& loaded, const std::string& less,
                const std::string& more, bool or_equal) {
  const auto a = std::get<double>(GetOption(loaded.options, less)),
             b = std::get<double>(GetOption(loaded.options, more));
  if (a < b || (or_equal && a == b)) return;
  throw ConfigError(file + ": " + Named(loaded, less) + " must be " + (or_equal ? "at most " : "below ") +
                    Named(loaded, more));
}

}  // namespace

LoadedSettings LoadSettings(const std::string& path) {
  LoadedSettings loaded;
  std::vector<Setting> settings;
  ReadChain({path}, &settings, &loaded.notes);
  int method = 0;
  for (const Setting& s : settings) {
    // An old file's groups of other methods do not choose one.
    if (s.field->message_type() != nullptr && MethodOf(s.path) >= 0 && s.path.find('.') == std::string::npos)
      method = MethodOf(s.path);
  }
  loaded.options = DefaultsOf(static_cast<PipelineOptions::Method>(method));
  for (const Setting& s : settings) {
    const bool other_method = MethodOf(s.path) >= 0 && MethodOf(s.path) != method;
    if (s.path == "base" || other_method) continue;
    loaded.set[s.path] = s;
    if (s.field->message_type() != nullptr) continue;
    CheckAllowed(s);
    SetOption(s.path, s.value, &loaded.options);
  }
  CheckOrder(path, loaded, "surface.min_decay_ms", "surface.default_decay_ms", true);
  CheckOrder(path, loaded, "surface.default_decay_ms", "surface.max_decay_ms", true);
  CheckOrder(path, loaded, "points.min_depth_m", "points.max_depth_m", false);
  return loaded;
}

PipelineOptions LoadOptions(const std::string& path) {
  return path.empty() ? PipelineOptions() : LoadSettings(path).options;
}

PipelineOptions LoadOptionsFor(const Camera& camera, const std::string& path) {
  constexpr double kDefaultsFor = 640;  // pixels wide
  LoadedSettings loaded;
  if (!path.empty()) loaded = LoadSettings(path);
  PipelineOptions& o = loaded.options;
  const double relative = camera.width / kDefaultsFor, scale = std::max(1.0, relative);
  if (loaded.set.count("keyframes.n_event") == 0)
    o.keyframes.n_event = static_cast<int>(std::lround(scale * o.keyframes.n_event));
  if (loaded.set.count("points.margin_px") == 0) o.points.margin_px *= scale;
  // Edges are lines: a narrower image has room for fewer points, and more only repeat them. Half at least:
  // with fewer, single keyframes of a DAVIS240 that EVT tracks by events alone lie several centimetres off.
  if (loaded.set.count("points.per_keyframe") == 0)
    o.points.per_keyframe =
        static_cast<int>(std::lround(std::clamp(relative, 0.5, 1.0) * o.points.per_keyframe));
  return o;
}

}  // namespace evit
