#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "tools/formats/import/import_log.h"

/// What the subcommands of `evit import`, one per source, share.
namespace evit::commands {

/// `import` itself: a recording of whatever format.
void AddImportRecording(CLI::App* import);
void AddImportVector(CLI::App* import);
void AddImportRpg(CLI::App* import);
void AddImportBag(CLI::App* import);

struct ImportOptions {
  std::string out, transform, seconds, accel_unit = "m/s^2", gyro_unit = "rad/s";
  bool any_imu = false;

  void AddTo(CLI::App* source, bool require_out = true);
  /// Throws std::runtime_error naming the option.
  void Apply(formats::ImportTarget* target) const;
};

/// Does the work under a progress bar, then prints the summary. `no_truth`: where truth was looked for in
/// vain.
void RunImport(const std::string& label, const formats::ImportTarget& target, const std::string& no_truth,
               const std::function<formats::ImportSummary(const std::function<void(double)>&)>& work);

}  // namespace evit::commands
