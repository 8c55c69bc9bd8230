#pragma once

#include <string>

#include "common/config/settings_file.h"

namespace evit {

enum class ShowKind {
  kAll,     // every value in force
  kChanges  // those that differ from the defaults
};

/// A settings file with the values in force and no comments. It loads to the same options, and needs no other
/// file.
std::string SettingsText(const PipelineOptions& options, ShowKind kind = ShowKind::kAll);

/// The same for people: with each value its unit, what is allowed, what it means and where it was set.
std::string CommentedSettings(const LoadedSettings& settings, ShowKind kind = ShowKind::kAll);

/// All keys of all methods as Markdown tables: key, default, unit and range, meaning.
std::string SettingsMarkdown();

}  // namespace evit
