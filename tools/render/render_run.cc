#include "tools/render/render_run.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <opencv2/videoio.hpp>
#include <stdexcept>
#include <vector>

#include "common/config/rig_file.h"
#include "common/files/staged_file.h"
#include "common/map/map_file.h"
#include "common/service/stop_signals.h"
#include "tools/render/gif_writer.h"
#include "tools/terminal/progress_bar.h"

namespace evit::render {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kSamples = 6;  // pictures that the colours of a GIF are taken from

// Stamps (us) of the pictures.
std::vector<std::int64_t> Moments(const RecordedRun& run, const RenderOptions& o) {
  const auto begin = static_cast<double>(run.begin());
  double from = 1e-6 * (static_cast<double>(run.windows().front().utime) - begin),
         to = 1e-6 * (static_cast<double>(run.windows().back().utime) - begin);
  if (o.seconds) {
    from = std::max(from, o.seconds->first);
    to = std::min(to, o.seconds->second);
  }
  std::vector<std::int64_t> moments;
  for (int i = 0; from + i * o.speed / o.fps <= to; ++i) {
    moments.push_back(static_cast<std::int64_t>(begin + 1e6 * (from + i * o.speed / o.fps)));
  }
  if (moments.empty()) throw std::runtime_error(o.log + ": the part asked for is not in it");
  return moments;
}

// Draws all moments, or throws where the user wants no more.
void DrawAll(const std::vector<std::int64_t>& moments, RunPainter* painter,
             const std::function<void(const cv::Mat&)>& take) {
  const StopSignals signals;
  terminal::ProgressBar progress("rendering");
  for (std::size_t i = 0; i < moments.size(); ++i) {
    if (signals.received()) throw std::runtime_error("interrupted");
    take(painter->Paint(moments[i]));
    progress.Show(static_cast<double>(i + 1) / static_cast<double>(moments.size()));
  }
}

void WriteGif(const std::string& part, const RenderOptions& o, const std::vector<std::int64_t>& moments,
              RunPainter* painter) {
  std::vector<cv::Mat> samples;
  for (std::size_t k = 0; k < kSamples; ++k) {
    samples.push_back(painter->Paint(moments[k * (moments.size() - 1) / (kSamples - 1)]));
  }
  GifWriter writer(part, o.paint.size, std::max(2, static_cast<int>(std::lround(100 / o.fps))),
                   Palette(samples));
  DrawAll(moments, painter, [&](const cv::Mat& picture) { writer.Add(picture); });
  writer.Close();
}

void WriteMp4(const std::string& part, const RenderOptions& o, const std::vector<std::int64_t>& moments,
              RunPainter* painter) {
  cv::VideoWriter writer;
  // H.264 is what browsers play; where OpenCV has none, MPEG-4.
  for (const char* codec : {"avc1", "mp4v"}) {
    const int fourcc = cv::VideoWriter::fourcc(codec[0], codec[1], codec[2], codec[3]);
    if (writer.open(part, cv::CAP_FFMPEG, fourcc, o.fps, o.paint.size)) break;
  }
  if (!writer.isOpened())
    throw std::runtime_error("cannot write " + o.out + ": OpenCV has no encoder for MP4; try .gif");
  DrawAll(moments, painter, [&](const cv::Mat& picture) { writer.write(picture); });
}

}  // namespace

int RenderRun(const RenderOptions& o) {
  const fs::path out(o.out);
  const std::string kind = out.extension();
  if (kind != ".mp4" && kind != ".gif") {
    throw std::runtime_error("--out " + o.out + ": expected a name that ends with .mp4 or .gif");
  }
  const RecordedRun run(o.log, o.prefix);
  const std::vector<std::int64_t> moments = Moments(run, o);
  RunPainter painter(&run, LoadMap(o.map).map, LoadRig(o.rig), o.paint);
  StagedFile file(o.out, StagedFile::Name::kPartExtension);  // OpenCV tells from it what to write
  if (kind == ".gif") {
    WriteGif(file.part(), o, moments, &painter);
  } else {
    WriteMp4(file.part(), o, moments, &painter);
  }
  file.Commit();
  return static_cast<int>(moments.size());
}

}  // namespace evit::render
