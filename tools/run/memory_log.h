#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "tools/run/pipeline.h"

namespace evit::run {

/// Physical memory of each service over time, one sample a second.
class MemoryLog {
 public:
  explicit MemoryLog(const Pipeline* pipeline);

  void Tick();  // call often

  /// FOLDER/memory.csv (seconds, MB of each service) and memory.png. Throws std::runtime_error naming the
  /// file.
  void Write(const std::string& folder) const;

 private:
  using Clock = std::chrono::steady_clock;
  const Pipeline* pipeline_;
  Clock::time_point begin_ = Clock::now(), last_;
  std::vector<double> seconds_;
  std::vector<std::vector<double>> mb_;  // per service
};

}  // namespace evit::run
