#pragma once

#include <filesystem>
#include <string>

#include "common/geometry/rig.h"
#include "tools/simulation/simulated_imu.h"
#include "tools/simulation/simulator.h"

namespace evit::simulation {

/// A folder beside the final one that becomes it only when everything is written.
class StagedFolder {
 public:
  /// Throws std::runtime_error where the folder cannot be made or is a file.
  explicit StagedFolder(const std::string& final_folder);
  ~StagedFolder();  // without Commit: removes what was staged
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  std::string File(const std::string& name) const { return (staging_ / name).string(); }
  void Commit();

 private:
  std::filesystem::path final_, staging_;
  bool made_ = false;  // the final folder
};

/// All throw std::runtime_error naming the file.
void WriteImuFile(const std::string& path, const SimulatedImu& imu);
/// Marker poses at 120 Hz, as the motion capture gives them.
void WriteGroundTruthFile(const std::string& path, const std::string& name, const Motion& motion,
                          const Rig& rig);
void WriteTruth(const std::string& path, const Motion& motion, const SimulatedImu& imu);
void WriteReport(const std::string& path, const SimulationSettings& settings,
                 const SimulationSummary& summary);

}  // namespace evit::simulation
