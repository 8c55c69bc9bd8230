#pragma once

#include <string>
#include <vector>

#include "common/config/pipeline_options.h"
#include "common/config/setting.h"

namespace evit {

/// Where each option stands in a settings file: the one table between option structs and schema. Paths are as
/// in "evit.window.size"; enums have the numbers of the schema. An unknown path is a std::logic_error.
std::vector<std::string> OptionPaths();
SettingValue GetOption(const PipelineOptions& options, const std::string& path);
/// `value` must be of the type that GetOption gives for this path.
void SetOption(const std::string& path, const SettingValue& value, PipelineOptions* options);

/// The address of each option within `options`, as in OptionPaths().
std::vector<const void*> OptionAddresses(const PipelineOptions& options);

}  // namespace evit
