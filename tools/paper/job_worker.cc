#include "tools/paper/job_worker.h"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <utility>

#include "procman/command_line.h"
#include "tools/paper/text_files.h"

namespace evit::paper {

namespace {

// The last percentage in what a program says of its progress ("tracking: 30 % ..."); -1: none.
double ShareIn(const std::string& text) {
  const std::size_t at = text.rfind(" %");
  if (at == std::string::npos || at == 0) return -1;
  std::size_t begin = at;
  while (begin > 0 && std::isdigit(static_cast<unsigned char>(text[begin - 1])) != 0) --begin;
  return begin == at ? -1 : std::min(1.0, std::atof(text.substr(begin, at - begin).c_str()) / 100);
}

}  // namespace

JobWorker::JobWorker(const PaperJob* job, std::size_t index, std::string programs)
    : job_(job), index_(index), programs_(std::move(programs)) {
  std::filesystem::remove_all(job->folder);
  MakeFolder(job->folder);
  commands_ = job->prepare();
}

bool JobWorker::Succeeded() const {
  const auto& good = job_->good_codes;
  return std::find(good.begin(), good.end(), process_->exit_code()) != good.end();
}

void JobWorker::StartNext() {
  const auto& words = commands_[next_];
  procman::ProcmanCommand command;
  command.id = words.size() > 1 ? words[1] : "program";
  if (command.id.find_first_of("/-") != std::string::npos) command.id = "program";
  command.exec = procman::JoinCommandLine(words);
  command.stop_time_allowed = 5;
  process_ = std::make_unique<procman::ManagedProcess>(
      command, procman::ManagedProcess::Places{programs_, job_->folder},
      [this](const std::string&, const std::string& text) { share_ = std::max(share_, ShareIn(text)); });
  process_->Start();
}

JobWorker::State JobWorker::Tick() {
  if (process_ != nullptr) {
    process_->Tick();
    if (process_->running()) return State::kRunning;
    if (!Succeeded()) {
      failure_ = process_->end() + ": " + process_->LastWords();
      return State::kFailed;
    }
    process_.reset();
    ++next_;
    share_ = 0;
  }
  if (next_ < commands_.size()) {
    StartNext();
    return State::kRunning;
  }
  if (job_->finish) job_->finish();
  MarkDone(*job_);
  return State::kDone;
}

void JobWorker::Abandon() {
  if (process_ != nullptr) {
    process_->Stop();
    while (process_->running()) {
      process_->Tick();
      usleep(10'000);
    }
  }
  std::error_code ignored;
  std::filesystem::remove_all(job_->folder, ignored);
}

double JobWorker::share() const {
  return (static_cast<double>(next_) + share_) /
         static_cast<double>(std::max<std::size_t>(1, commands_.size()));
}

}  // namespace evit::paper
