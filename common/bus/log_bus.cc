#include "common/bus/log_bus.h"

#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "common/bus/log_file.h"

namespace evit {

namespace {

class LogBus : public Bus {
 public:
  LogBus(const std::string& source, const std::string& sink) : reader_(source) {
    if (!sink.empty()) writer_.emplace(sink);
  }

  void Publish(const std::string& channel, const void* data, std::size_t size) override {
    if (writer_) writer_->Write(utime_, channel, data, size);
  }

  void Subscribe(const std::string& channel, Handler handler) override {
    handlers_.emplace_back(channel, std::move(handler));
  }

  int Poll(int /*timeout_ms*/) override {
    while (next_ < reader_.entries().size()) {
      const LogEntry& entry = reader_.entries()[next_++];
      const std::string& channel = reader_.channel(entry);
      bool read = false;
      for (std::size_t h = 0; h < handlers_.size(); ++h) {
        if (handlers_[h].first != channel) continue;
        if (!read) reader_.Read(entry, &data_);
        read = true;
        utime_ = entry.utime;
        handlers_[h].second(channel, data_.data(), data_.size());
      }
      if (read) return 1;
    }
    return 0;
  }

 private:
  LogReader reader_;
  std::optional<LogWriter> writer_;
  std::deque<std::pair<std::string, Handler>> handlers_;
  std::vector<std::uint8_t> data_;
  std::size_t next_ = 0;
  std::int64_t utime_ = 0;
};

}  // namespace

std::unique_ptr<Bus> OpenLogBus(const std::string& source, const std::string& sink) {
  return std::make_unique<LogBus>(source, sink);
}

}  // namespace evit
