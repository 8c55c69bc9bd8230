#include "tools/formats/export/export_log.h"

#include <cstdio>
#include <iomanip>
#include <memory>
#include <stdexcept>

#include "common/files/decimal_time.h"
#include "common/files/staged_file.h"
#include "common/files/whole_file.h"
#include "tools/formats/export/log_streams.h"
#include "tools/formats/hdf5/event_file_writer.h"
#include "tools/formats/prophesee/evt3_writer.h"

namespace evit::formats {
namespace {

// RPG's imu.txt: t ax ay az gx gy gz. All digits, so that it reads back exactly.
void WriteImu(const std::string& path, const LogStreams& streams, Utime start) {
  WholeFile file(path);
  file.stream() << std::setprecision(17);
  for (const ImuSample& s : streams.imu) {
    file.stream() << DecimalSeconds(s.t - start);
    for (const Eigen::Vector3d* v : {&s.accel, &s.gyro})
      file.stream() << ' ' << v->x() << ' ' << v->y() << ' ' << v->z();
    file.stream() << '\n';
  }
  file.Commit();
}

void WriteTruth(const std::string& path, const LogStreams& streams, Utime start) {
  WholeFile file(path);
  for (StampedPose s : streams.truth) {
    s.t -= start;
    file.stream() << TumLine(s) << '\n';
  }
  file.Commit();
}

void WriteBeside(const std::string& imu, const std::string& truth, const LogStreams& streams, Utime start) {
  if (!streams.imu.empty()) WriteImu(imu, streams, start);
  if (!streams.truth.empty()) WriteTruth(truth, streams, start);
}

void WriteText(const LogExport& job, const std::string& path, const std::function<void(double)>& progress) {
  WholeFile file(path);
  std::string text;
  ReadLogEvents(job.log, [&](const EventArray& events, double share) {
    text.clear();
    char line[80];
    for (std::size_t k = 0; k < events.size(); ++k) {
      const Utime t = events.t[k];
      std::snprintf(line, sizeof line, "%lld.%06lld %d %d %d\n", static_cast<long long>(t / kMicrosPerSecond),
                    static_cast<long long>(t % kMicrosPerSecond), int{events.x[k]}, int{events.y[k]},
                    int{events.p[k]});
      text += line;
    }
    file.stream() << text;
    progress(share);
  });
  file.Commit();
}

template <typename Writer>
void WriteEvents(const LogExport& job, Writer writer, const std::function<void(double)>& progress) {
  ReadLogEvents(job.log, [&](const EventArray& events, double share) {
    writer->Append(events);
    progress(share);
  });
  writer->Close();
}

}  // namespace

ExportSummary ExportLog(const LogExport& job, const std::function<void(double)>& progress) {
  const LogStreams streams = ScanLog(job.log, job.allow_truncated);
  if (streams.first_event < 0)
    throw std::runtime_error(job.log + ": has stamps before zero, which these formats cannot hold");
  switch (job.format) {
    case ExportFormat::kRpg: {
      const StagedDirectory folder(job.out);
      WriteText(job, job.out + "/events.txt", progress);
      WriteBeside(job.out + "/imu.txt", job.out + "/groundtruth.txt", streams, 0);
      break;
    }
    case ExportFormat::kDsec:
      WriteEvents(job, std::make_unique<EventFileWriter>(job.out, streams.first_event), progress);
      WriteBeside(job.out + ".imu.txt", job.out + ".groundtruth.txt", streams, 0);
      break;
    case ExportFormat::kEvt3:
      WriteEvents(
          job,
          std::make_unique<Evt3Writer>(job.out, job.width > 0 ? job.width : streams.width,
                                       job.height > 0 ? job.height : streams.height, streams.first_event),
          progress);
      WriteBeside(job.out + ".imu.txt", job.out + ".groundtruth.txt", streams, streams.first_event);
      break;
  }
  progress(1);
  return {streams.n_events, static_cast<std::int64_t>(streams.imu.size()),
          static_cast<std::int64_t>(streams.truth.size())};
}

}  // namespace evit::formats
