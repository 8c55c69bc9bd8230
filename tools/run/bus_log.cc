#include "tools/run/bus_log.h"

#include <chrono>
#include <stdexcept>

namespace evit::run {

BusLog::BusLog(Bus* bus, const std::string& path, const std::vector<std::string>& channels) : log_(path) {
  for (const std::string& name : channels) {
    bus->Subscribe(name, [this](const std::string& channel, const std::uint8_t* data, std::size_t size) {
      if (!error_.empty()) return;
      const auto now = std::chrono::system_clock::now().time_since_epoch();
      try {
        log_.Write(std::chrono::duration_cast<std::chrono::microseconds>(now).count(), channel, data, size);
      } catch (const std::runtime_error& error) {
        error_ = error.what();
      }
    });
  }
}

void BusLog::Close() {
  if (!error_.empty()) throw std::runtime_error(error_);
  log_.Close();
}

}  // namespace evit::run
