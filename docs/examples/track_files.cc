// Poses from files, without LCM: events (t x y p: s, pixels, 0 or 1) and IMU samples (t ax ay az gx gy gz: s,
// m/s^2 with gravity, rad/s) as text, as `evit export rpg` writes them; a map; where the body is at the
// start.
//
//   track_files events.txt imu.txt map.pcd "x y z qx qy qz qw" > trajectory.tum
//
// The rig is that of logs/ in the sources: put your own in. CMakeLists.txt beside this file builds it.
// Exit code 2: it was not tracking at the end.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <opencv2/core.hpp>
#include <sstream>
#include <stdexcept>

#include "common/evaluation/trajectory.h"
#include "common/events/keyframe_builder.h"
#include "common/imu/imu_plausibility.h"
#include "common/map/denoise.h"
#include "common/map/map_file.h"
#include "common/map/map_index.h"
#include "common/tracking/feedback.h"
#include "common/tracking/map_tracker.h"

using namespace evit;

Rig SampleRig() {
  Rig rig;
  rig.camera.width = 320, rig.camera.height = 240;
  rig.camera.fx = 163.663745, rig.camera.fy = 163.73092, rig.camera.cx = 152.238745,
  rig.camera.cy = 117.438105;
  rig.camera.distortion = {-0.031982, 0.041966, -0.000507, -0.001031, 0};
  Eigen::Matrix4d T_body_camera;
  T_body_camera << 0.0112035401714, 0.0218441028472, 0.999698612512, 0.129074645497,  //
      -0.999760449519, -0.0185542304653, 0.0116096558815, 0.0793086622739,            //
      0.0188022409695, -0.999589203474, 0.0216309970154, 0.0250861654461, 0, 0, 0, 1;
  rig.T_body_camera = SE3(T_body_camera);
  rig.imu_noise.gyro_density = 7.3e-4, rig.imu_noise.accel_density = 1.27e-3;
  rig.imu_noise.gyro_random_walk = 7e-6, rig.imu_noise.accel_random_walk = 5.6e-5;
  rig.imu_rate_hz = 200;
  return rig;
}

Utime ToUtime(double seconds) { return std::llround(1e6 * seconds); }

std::vector<ImuSample> ReadImu(const std::string& path) {
  std::ifstream file(path);
  std::vector<ImuSample> samples;
  ImuSample s;
  for (double t;
       file >> t >> s.accel.x() >> s.accel.y() >> s.accel.z() >> s.gyro.x() >> s.gyro.y() >> s.gyro.z();) {
    s.t = ToUtime(t);
    samples.push_back(s);
  }
  if (samples.empty()) throw std::runtime_error(path + ": no IMU samples");
  const std::string complaint = ImuComplaint(samples);  // units, swapped columns, gravity taken off
  if (!complaint.empty()) throw std::runtime_error(path + ": " + complaint);
  return samples;
}

EventArray ReadEvents(const std::string& path) {
  std::ifstream file(path);
  EventArray events;
  for (double t, x, y, p; file >> t >> x >> y >> p;)
    events.push_back(ToUtime(t), static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), p > 0 ? 1 : 0);
  if (events.size() == 0) throw std::runtime_error(path + ": no events");
  return events;
}

int Track(char** arguments) {
  const EventArray events = ReadEvents(arguments[1]);
  const std::vector<ImuSample> imu = ReadImu(arguments[2]);
  PointMap points = LoadMap(arguments[3]).map;
  // As map_server does; leaves maps of `evit map build` alone.
  Denoise(DenoiseSettingsFor(points, Summarize(points).median_spacing), &points);
  const MapIndex map(std::move(points));
  SE3 start;
  std::istringstream(arguments[4]) >> start.p.x() >> start.p.y() >> start.p.z() >> start.q.x() >>
      start.q.y() >> start.q.z() >> start.q.w();

  const Rig rig = SampleRig();
  const KeyframeBuilder::Options drawing;
  TrackerOptions tracking;
  tracking.lag_px = drawing.surface.lag_px;  // these two must agree
  tracking.min_events = drawing.keyframes.min_events;
  // As EVIT's services do: an image narrower than 640 pixels has room for fewer points.
  tracking.points.per_keyframe = tracking.points.per_keyframe * std::clamp(rig.camera.width, 320, 640) / 640;
  KeyframeBuilder builder(rig, drawing, /*lossless=*/true);
  const auto tracker = MakeTracker(rig, tracking, start);
  builder.AddEvents(events, events.t.back());
  for (const ImuSample& sample : imu) builder.AddImu(sample);
  builder.Flush();

  TrackerOutput out;
  int n_poses = 0;
  while (auto keyframe = builder.Next()) {
    // The map points that the tracker needs for it: here from the index, in EVIT's services from map_server.
    std::vector<Eigen::Vector3f> visible;
    const VisibilityAnswer seen = map.Query(tracker->NextQuery());
    for (const std::int32_t id : seen.ids) visible.push_back(map.map().points[static_cast<std::size_t>(id)]);
    tracker->AddVisible(seen.ids, visible);

    const cv::Mat surface(keyframe->height, keyframe->width, CV_8UC1, keyframe->surface.data());
    out = tracker->Process({keyframe->utime, keyframe->seq, static_cast<int>(keyframe->n_events), surface,
                            keyframe->imu, keyframe->imu_gap});
    // Which keyframe comes next, and how fast its surface decays, depends on this.
    builder.SetFeedbackFor(keyframe->seq, FeedbackOf(out));
    if (out.mode != TrackerMode::kTracking || !out.has_pose) continue;
    std::printf("%s\n", TumLine({keyframe->utime, out.nodes.back().state.T_map_body}).c_str());
    ++n_poses;
  }
  const bool tracks = tracker->mode() == TrackerMode::kTracking;
  std::fprintf(stderr, "track_files: %d poses; at the end: %s\n", n_poses, out.reason.c_str());
  if (tracks)  // position first, in m
    std::fprintf(stderr, "standard deviation of the position: %.1f mm\n",
                 1e3 * std::sqrt(out.covariance.topLeftCorner<3, 3>().trace()));
  return tracks ? 0 : 2;
}

int main(int argc, char** argv) try {
  if (argc == 5) return Track(argv);
  std::fprintf(stderr, "usage: track_files EVENTS IMU MAP \"x y z qx qy qz qw\"\n");
  return 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "track_files: %s\n", error.what());
  return 1;
}
