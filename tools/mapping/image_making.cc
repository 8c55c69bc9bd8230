#include "tools/mapping/image_making.h"

#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "common/config/rig_file.h"
#include "tools/mapping/build_report.h"
#include "tools/mapping/depth_frames.h"
#include "tools/mapping/rgbd_views.h"
#include "tools/terminal/progress_bar.h"

namespace evit::mapping {
namespace {

namespace fs = std::filesystem;

constexpr double kMillimetres = 1000, kTumUnits = 5000;  // of 16-bit depth per metre

// What the poses are of, and the cameras that hang on it.
class PosedCameras {
 public:
  explicit PosedCameras(const MapMaking& m) : m_(m), of_(m.poses_of.value_or(PosedFrame::kCamera)) {
    TumSkipped skipped;
    posed_ = ReadTum(m.poses, &skipped);
    if (skipped.rows > 0) std::fprintf(stderr, "note: %s\n", skipped.Text(m.poses).c_str());
  }

  /// T_map_camera by the stamps of the camera's pictures. `first`: the camera that poses of a camera are of.
  Trajectory Of(const MountedCamera& camera, const std::string& file, const MountedCamera& first,
                bool is_first) const {
    if (of_ != PosedFrame::kCamera || !is_first) {
      for (const bool mounted : {camera.mounted, of_ != PosedFrame::kCamera || first.mounted}) {
        if (!mounted) {
          throw std::runtime_error(file + ": T_body_camera is missing" +
                                   (camera.mounted ? " from the first camera's file" : "") +
                                   ": where the camera sits on what the poses of " + m_.poses + " tell of");
        }
      }
    }
    SE3 T_posed_camera;
    if (of_ == PosedFrame::kMarker) T_posed_camera = camera.T_marker_body * camera.T_body_camera;
    if (of_ == PosedFrame::kBody) T_posed_camera = camera.T_body_camera;
    if (of_ == PosedFrame::kCamera && !is_first)
      T_posed_camera = first.T_body_camera.Inverse() * camera.T_body_camera;
    Trajectory poses = posed_;
    for (StampedPose& pose : poses) {
      pose.pose = m_.T_map_world * pose.pose * T_posed_camera;
      pose.t -= camera.time_offset;
    }
    return poses;
  }

 private:
  const MapMaking& m_;
  PosedFrame of_;
  Trajectory posed_;
};

MadeMap BuildFromDepths(RgbdEdges edges, const MapBuilderOptions& options) {
  terminal::ProgressBar bar("building");
  return {BuildMapFromDepths(std::move(edges.frames.views), std::move(edges.depths), options,
                             [&](double share, const std::string& what) { bar.Show(share, what); }),
          std::move(edges.frames.stamps)};
}

struct ReadCamera {
  FrameList list;
  ReadFrames frames;
};

ReadCamera ReadOne(const MapMaking& m, std::size_t k, const Camera& camera, const Trajectory& poses) {
  std::unique_ptr<formats::FrameSource> source;
  {
    terminal::ProgressBar bar("listing " + m.images[k]);
    bar.Show(0);
    source = formats::OpenFrames(m.images[k], {k < m.topics.size() ? m.topics[k] : "", false});
  }
  ReadCamera read;
  read.list = ListFrames(*source, m.images[k], poses, m.poses);
  if (!m.frames.empty()) TakeRange(m.frames, &read.list);
  FrameReaderOptions options = m.reader;
  options.max_frames = std::max<std::size_t>(3, options.max_frames / m.images.size());
  terminal::ProgressBar bar("reading " + std::to_string(read.list.frames.size()) + " pictures");
  bar.Show(0);
  read.frames = ReadEdges(read.list, source.get(), camera, options, [&](double share) { bar.Show(share); });
  return read;
}

RgbdEdges ReadDepths(const MapMaking& m, ReadCamera read, const MountedCamera& first,
                     const PosedCameras& posed) {
  const bool own_camera = !m.depth.camera.empty();
  const MountedCamera camera = own_camera ? LoadMountedCamera(m.depth.camera) : first;
  const auto source = formats::OpenFrames(m.depth.images, {m.depth.topic, true});
  DepthFrames depth;
  depth.source = source.get();
  depth.path = m.depth.images;
  depth.camera = camera.camera;
  depth.poses = posed.Of(camera, m.depth.camera, first, !own_camera);
  depth.clock_offset = camera.time_offset - first.time_offset;
  depth.units_per_metre = m.depth.units_per_metre > 0 ? m.depth.units_per_metre : kMillimetres;
  depth.max_depth_m = m.build.stereo.max_depth_m;
  depth.threads = m.reader.threads;
  terminal::ProgressBar bar("reading depth");
  bar.Show(0);
  return AddDepths(std::move(read.frames), depth, [&](double share) { bar.Show(share); });
}

// One trajectory of stamps: by camera, then by time.
void Append(ReadFrames more, ReadFrames* frames) {
  for (PosedEdges& view : more.views) frames->views.push_back(std::move(view));
  frames->stamps.insert(frames->stamps.end(), more.stamps.begin(), more.stamps.end());
}

bool HasTumLayout(const std::string& folder) {
  return fs::is_regular_file(folder + "/rgb.txt") && fs::is_regular_file(folder + "/depth.txt");
}

// What TUM's own documentation says to take with its registered depth images, which have no calibration file.
constexpr char kTumCamera[] =
    "the camera is taken to be TUM's usual one (640x480, f 525, centre 319.5 239.5, no distortion); name "
    "another with --camera";

MountedCamera TumCamera() {
  MountedCamera mounted;
  mounted.camera.width = 640, mounted.camera.height = 480;
  mounted.camera.fx = mounted.camera.fy = 525;
  mounted.camera.cx = 319.5, mounted.camera.cy = 239.5;
  return mounted;
}

// `usual`: of a camera that has no file.
MadeMap Make(const MapMaking& m, const MountedCamera* usual) {
  std::vector<MountedCamera> cameras;
  for (const std::string& file : m.cameras) cameras.push_back(LoadMountedCamera(file));
  if (cameras.empty() && usual != nullptr) cameras.push_back(*usual);
  if (m.poses.empty() || cameras.empty()) throw std::runtime_error("--images needs --poses and --camera");
  if (cameras.size() != m.images.size() || m.topics.size() > m.images.size()) {
    throw std::runtime_error("--images names " + std::to_string(m.images.size()) +
                             " cameras' pictures, --camera " + std::to_string(cameras.size()) +
                             " files: one for each, in the same order");
  }
  if (!m.depth.images.empty() && cameras.size() > 1)
    throw std::runtime_error("--depth goes with the pictures of one camera, not of two");
  const PosedCameras posed(m);
  const auto read = [&](std::size_t k) {
    const std::string file = m.cameras.empty() ? "" : m.cameras[k];
    ReadCamera one = ReadOne(m, k, cameras[k].camera, posed.Of(cameras[k], file, cameras[0], k == 0));
    PrintNotes(one.list, one.frames);
    if (one.frames.contrast < m.reader.edges.sure_contrast)
      std::fprintf(stderr, "note: few edges are strong: --contrast %.2f was taken\n", one.frames.contrast);
    return one;
  };
  ReadCamera first = read(0);
  if (!m.depth.images.empty())
    return BuildFromDepths(ReadDepths(m, std::move(first), cameras[0], posed), m.build);
  ReadFrames frames = std::move(first.frames);
  for (std::size_t k = 1; k < cameras.size(); ++k) Append(read(k).frames, &frames);
  terminal::ProgressBar bar("building");
  return {BuildMap(std::move(frames.views), m.build,
                   [&](double share, const std::string& what) { bar.Show(share, what); }),
          std::move(frames.stamps)};
}

}  // namespace

void PrintNotes(const FrameList& list, const ReadFrames& frames) {
  for (const std::string& note : NotesOn(list, frames)) std::fprintf(stderr, "note: %s\n", note.c_str());
}

MadeMap MakeFromImages(const MapMaking& making) { return Make(making, nullptr); }

MadeMap MakeFromRgbd(const MapMaking& m) {
  if (HasTumLayout(m.rgbd)) {
    MapMaking tum = m;
    tum.images = {m.rgbd};
    tum.depth.images = m.rgbd;
    if (tum.depth.units_per_metre <= 0) tum.depth.units_per_metre = kTumUnits;
    if (tum.poses.empty()) tum.poses = m.rgbd + "/groundtruth.txt";
    const MountedCamera usual = TumCamera();
    if (m.cameras.empty()) std::fprintf(stderr, "note: %s\n", kTumCamera);
    return Make(tum, &usual);
  }
  const auto [begin, end] =
      m.frames.empty() ? std::make_pair(std::size_t{0}, std::size_t{1'000'000}) : ParseRange(m.frames);
  RgbdEdges edges;
  {
    terminal::ProgressBar bar("reading " + m.rgbd);
    bar.Show(0);
    edges = ReadRgbd(m.rgbd, begin, end, m.reader, m.build.stereo.max_depth_m,
                     [&](double share) { bar.Show(share); });
  }
  PrintNotes({}, edges.frames);
  return BuildFromDepths(std::move(edges), m.build);
}

}  // namespace evit::mapping
