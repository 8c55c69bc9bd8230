#include "tools/run/bus_log.h"

#include <chrono>
#include <stdexcept>

namespace evit::run {

BusLog::BusLog(Bus* bus, const std::string& path, const std::vector<std::string>& channels)
    : path_(path), file_(path) {
  log_.emplace(file_->part());
  for (const std::string& name : channels) {
    bus->Subscribe(name, [this](const std::string& channel, const std::uint8_t* data, std::size_t size) {
      Write(channel, data, size);
    });
  }
}

BusLog::~BusLog() {
  try {
    Close();
  } catch (const std::runtime_error&) {  // the run failed already, and that is what is reported
  }
}

void BusLog::Write(const std::string& channel, const void* data, std::size_t size) {
  if (!log_) return;
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  try {
    log_->Write(std::chrono::duration_cast<std::chrono::microseconds>(now).count(), channel, data, size);
  } catch (const std::runtime_error& error) {
    Fail(error);
  }
}

void BusLog::Fail(const std::runtime_error& error) {
  error_ = "--record " + path_ + ": " + error.what() + "; nothing of it is kept: make room, then run again";
  log_.reset();
  file_.reset();  // at once: the results need the room
}

void BusLog::Close() {
  if (log_) {
    try {
      log_->Close();
      file_->Commit();
      log_.reset();
    } catch (const std::runtime_error& error) {
      Fail(error);
    }
  }
  if (!error_.empty()) throw std::runtime_error(error_);
}

}  // namespace evit::run
