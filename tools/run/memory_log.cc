#include "tools/run/memory_log.h"

#include <fstream>
#include <stdexcept>

#include "procman/process_usage.h"
#include "tools/pictures/chart.h"
#include "tools/pictures/write_picture.h"

namespace evit::run {

MemoryLog::MemoryLog(const Pipeline* pipeline) : pipeline_(pipeline), mb_(pipeline->processes().size()) {}

void MemoryLog::Tick() {
  const Clock::time_point now = Clock::now();
  if (now - last_ < std::chrono::seconds(1)) return;
  last_ = now;
  seconds_.push_back(std::chrono::duration<double>(now - begin_).count());
  for (std::size_t k = 0; k < mb_.size(); ++k) {
    const procman::ManagedProcess& process = *pipeline_->processes()[k];
    const procman::ProcessUsage usage =
        process.running() ? procman::ReadProcessUsage(process.pid()) : procman::ProcessUsage();
    mb_[k].push_back(static_cast<double>(usage.rss_bytes) / (1 << 20));
  }
}

void MemoryLog::Write(const std::string& folder) const {
  constexpr int kDashes[] = {0, 18, 10, 4};
  std::ofstream csv(folder + "/memory.csv");
  csv << "seconds";
  pictures::Chart chart{"physical memory of each service", "time [s]", "[MB]", {}, false, true};
  for (std::size_t k = 0; k < mb_.size(); ++k) {
    const std::string& name = pipeline_->processes()[k]->command().id;
    csv << ',' << name << "_mb";
    chart.series.push_back({name, pictures::kSafeColors[k % 4], seconds_, mb_[k], true, 0, kDashes[k % 4]});
  }
  csv << '\n';
  for (std::size_t i = 0; i < seconds_.size(); ++i) {
    csv << seconds_[i];
    for (const auto& values : mb_) csv << ',' << values[i];
    csv << '\n';
  }
  csv.close();
  if (!csv) throw std::runtime_error(folder + "/memory.csv: cannot be written");
  cv::Mat image(500, 1100, CV_8UC3, cv::Scalar(255, 255, 255));
  chart.Draw(&image, {10, 10, 1080, 480});
  pictures::WritePicture(folder + "/memory.png", image);
}

}  // namespace evit::run
