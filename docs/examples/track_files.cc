// Poses from files, without LCM: events (t x y p: s, pixels, 0 or 1) and IMU samples (t gx gy gz ax ay az: s,
// rad/s, m/s^2) as text, a map, and where the body is at the start.
//
//   track_files events.txt imu.txt map.pcd "x y z qx qy qz qw" > trajectory.tum
//
// The rig is that of logs/ in the sources: put your own in. Links evit::tracking, evit::events and
// evit::evaluation.
#include <cmath>
#include <cstdio>
#include <fstream>
#include <opencv2/core.hpp>
#include <sstream>

#include "common/evaluation/trajectory.h"
#include "common/events/keyframe_builder.h"
#include "common/map/map_file.h"
#include "common/map/map_index.h"
#include "common/tracking/map_tracker.h"

evit::Rig SampleRig() {
  evit::Rig rig;
  rig.camera.width = 320, rig.camera.height = 240;
  rig.camera.fx = 163.663745, rig.camera.fy = 163.73092, rig.camera.cx = 152.238745,
  rig.camera.cy = 117.438105;
  rig.camera.distortion = {-0.031982, 0.041966, -0.000507, -0.001031, 0};
  Eigen::Matrix4d T_body_camera;
  T_body_camera << 0.0112035401714, 0.0218441028472, 0.999698612512, 0.129074645497,  //
      -0.999760449519, -0.0185542304653, 0.0116096558815, 0.0793086622739,            //
      0.0188022409695, -0.999589203474, 0.0216309970154, 0.0250861654461, 0, 0, 0, 1;
  rig.T_body_camera = evit::SE3(T_body_camera);
  rig.imu_noise.gyro_density = 7.3e-4, rig.imu_noise.accel_density = 1.27e-3;
  rig.imu_noise.gyro_random_walk = 7e-6, rig.imu_noise.accel_random_walk = 5.6e-5;
  rig.imu_rate_hz = 200;
  return rig;
}

evit::Utime ToUtime(double seconds) { return std::llround(1e6 * seconds); }

int main(int argc, char** argv) {
  if (argc != 5) return std::fprintf(stderr, "usage: track_files EVENTS IMU MAP \"x y z qx qy qz qw\"\n"), 1;
  std::ifstream event_file(argv[1]), imu_file(argv[2]);
  evit::SE3 start;
  std::istringstream(argv[4]) >> start.p.x() >> start.p.y() >> start.p.z() >> start.q.x() >> start.q.y() >>
      start.q.z() >> start.q.w();
  const evit::Rig rig = SampleRig();
  const evit::MapIndex map(evit::LoadMap(argv[3]).map);
  evit::KeyframeBuilder builder(rig, {}, /*lossless=*/true);
  const auto tracker = evit::MakeTracker(rig, {}, start);

  evit::ImuSample sample;
  for (double t; imu_file >> t >> sample.gyro.x() >> sample.gyro.y() >> sample.gyro.z() >> sample.accel.x() >>
                 sample.accel.y() >> sample.accel.z();) {
    sample.t = ToUtime(t);
    builder.AddImu(sample);
  }
  evit::EventArray events;
  for (double t, x, y, p; event_file >> t >> x >> y >> p;) {
    events.push_back(ToUtime(t), static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), p > 0 ? 1 : 0);
  }
  if (events.size() == 0) return std::fprintf(stderr, "track_files: no events in %s\n", argv[1]), 1;
  builder.AddEvents(events, events.t.back());
  builder.Flush();

  while (auto keyframe = builder.Next()) {
    // The map points that the tracker needs for it: here from the index, in EVIT's services from map_server.
    std::vector<Eigen::Vector3f> points;
    const evit::VisibilityAnswer seen = map.Query(tracker->NextQuery());
    for (const std::int32_t id : seen.ids) points.push_back(map.map().points[static_cast<std::size_t>(id)]);
    tracker->AddVisible(seen.ids, points);

    const cv::Mat surface(keyframe->height, keyframe->width, CV_8UC1, keyframe->surface.data());
    const evit::TrackerOutput out =
        tracker->Process({keyframe->utime, keyframe->seq, static_cast<int>(keyframe->n_events), surface,
                          keyframe->imu, keyframe->imu_gap});
    if (out.mode == evit::TrackerMode::kTracking && out.has_pose)
      std::printf("%s\n", evit::TumLine({keyframe->utime, out.nodes.back().state.T_map_body}).c_str());
    // Which keyframe comes next, and how fast its surface decays, depends on this.
    builder.SetFeedbackFor(keyframe->seq,
                           {static_cast<evit::TrackerFeedback::Mode>(out.mode), out.image_speed, 1});
  }
  return tracker->mode() == evit::TrackerMode::kTracking ? 0 : 2;
}
