#include "tools/run/pipeline.h"

#include <filesystem>
#include <stdexcept>

namespace evit {
namespace {

constexpr int kMaxRestarts = 20;

}  // namespace

Pipeline::Pipeline(const std::vector<ServiceCommand>& services, const std::string& programs,
                   const std::string& logs)
    : services_(services) {
  for (const ServiceCommand& service : services_) {
    const std::string log = (std::filesystem::path(logs) / (service.name + ".log")).string();
    std::filesystem::remove(log);
    children_.push_back(std::make_unique<Child>(
        service.name, (std::filesystem::path(programs) / service.name).string(), service.arguments, log));
  }
}

void Pipeline::Watch() {
  for (std::size_t k = 0; k < children_.size(); ++k) {
    Child& child = *children_[k];
    if (child.Running()) continue;
    if (services_[k].replaceable && restarts_ < kMaxRestarts) {
      ++restarts_;
      child.Start();
      continue;
    }
    const std::string words = child.LastWords();
    throw std::runtime_error(child.name() + " died with " + child.end() +
                             (words.empty() ? ", without a word" : "; its last words:" + words));
  }
}

void Pipeline::Stop() {
  for (auto child = children_.rbegin(); child != children_.rend(); ++child) (*child)->Stop();
}

}  // namespace evit
