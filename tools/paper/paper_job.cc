#include "tools/paper/paper_job.h"

#include <filesystem>

#include "tools/paper/text_files.h"

namespace evit::paper {

namespace {

constexpr char kKeyFile[] = "/key.txt";

}  // namespace

bool IsDone(const PaperJob& job) {
  const std::string path = job.folder + kKeyFile;
  return std::filesystem::exists(path) && ReadText(path) == job.key;
}

void MarkDone(const PaperJob& job) { WriteText(job.folder + kKeyFile, job.key); }

}  // namespace evit::paper
