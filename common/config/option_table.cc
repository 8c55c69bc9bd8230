#include "common/config/option_table.h"

#include <stdexcept>
#include <type_traits>

namespace evit {
namespace {

// visit(path, member) of each option. Options: PipelineOptions, const or not.
template <typename Options, typename Visitor>
void VisitOptions(Options& o, const Visitor& visit) {
  visit("keyframes.n_event", o.keyframes.n_event);
  visit("keyframes.n_imu", o.keyframes.n_imu);
  visit("keyframes.relaxed_interval_ms", o.keyframes.relaxed_interval_ms);
  visit("keyframes.max_interval_ms", o.keyframes.max_interval_ms);
  visit("keyframes.min_events", o.keyframes.min_events);
  visit("keyframes.fixed_rate_hz", o.keyframes.fixed_rate_hz);
  visit("keyframes.bootstrap_interval_ms", o.keyframes.bootstrap_interval_ms);
  visit("surface.kind", o.surface.kind);
  visit("surface.lookahead_ms", o.surface.lookahead_ms);
  visit("surface.tail_px", o.surface.tail_px);
  visit("surface.min_decay_ms", o.surface.min_decay_ms);
  visit("surface.max_decay_ms", o.surface.max_decay_ms);
  visit("surface.default_decay_ms", o.surface.default_decay_ms);
  visit("surface.truncation", o.surface.truncation);
  visit("surface.blur_sigma_px", o.surface.blur_sigma_px);
  visit("surface.support_filter", o.surface.support_filter);
  visit("surface.lag_px", o.surface.lag_px);
  visit("surface.hot_pixel_rate_hz", o.surface.hot_pixel_rate_hz);
  visit("points.max_active", o.points.max_active);
  visit("points.per_keyframe", o.points.per_keyframe);
  visit("points.margin_px", o.points.margin_px);
  visit("points.min_depth_m", o.points.min_depth_m);
  visit("points.max_depth_m", o.points.max_depth_m);
  visit("points.occlusion", o.points.occlusion);
  visit("points.seed", o.points.seed);
  visit("alignment.kernel", o.window.kernel);
  visit("alignment.image_sigma", o.window.image_sigma);
  visit("alignment.robust_scale", o.window.robust_scale);
  visit("alignment.min_contrast", o.failure.min_contrast);
  visit("covariance.correlated_share", o.window.correlated_share);
  visit("covariance.misfit_share", o.window.misfit_share);
  visit("covariance.map_sigma_m", o.window.map_sigma_m);
  visit("covariance.stamp_sigma_us", o.window.stamp_sigma_us);
  visit("evit.motion_model", o.window.motion_model);
  visit("evit.window.size", o.window.size);
  visit("evit.window.first_node", o.window.first_node);
  visit("evit.window.max_iterations", o.window.max_iterations);
  visit("evit.window.imu_noise_factor", o.window.imu_noise_factor);
  visit("evit.bootstrap.min_frames", o.bootstrap.min_frames);
  visit("evit.bootstrap.min_displacement_m", o.bootstrap.min_displacement_m);
  visit("evit.bootstrap.min_rotation_deg", o.bootstrap.min_rotation_deg);
  visit("evit.bootstrap.max_duration_s", o.bootstrap.max_duration_s);
  visit("evit.bootstrap.max_gyro_bias", o.bootstrap.max_gyro_bias);
  visit("evit.bootstrap.max_accel_bias", o.bootstrap.max_accel_bias);
  visit("evit.bootstrap.min_contrast", o.bootstrap.min_contrast);
  visit("evit.failure.max_coast_s", o.failure.max_coast_s);
  visit("evit.failure.max_position_sigma_m", o.failure.max_position_sigma_m);
  visit("evit.failure.max_speed", o.failure.max_speed);
  visit("evit.failure.max_gyro_bias", o.failure.max_gyro_bias);
  visit("evit.failure.max_accel_bias", o.failure.max_accel_bias);
  visit("evit.failure.max_imu_gap_ms", o.failure.max_imu_gap_ms);
  visit("evt.motion_model", o.window.motion_model);
  visit("evpt.contrast_threshold", o.photometric.contrast_threshold);
  visit("evpt.view_margin", o.photometric.view_margin);
  visit("evpt.blur_sigma_px", o.photometric.blur_sigma_px);
  visit("evpt.levels", o.photometric.levels);
  visit("evpt.max_points", o.photometric.max_points);
  visit("evpt.min_gradient", o.photometric.min_gradient);
  visit("evpt.robust_scale", o.photometric.robust_scale);
  visit("evpt.max_iterations", o.photometric.max_iterations);
  visit("evpt.sigma_position_m", o.photometric.sigma_position_m);
  visit("evpt.sigma_rotation_rad", o.photometric.sigma_rotation_rad);
  visit("evpt.sigma_velocity", o.photometric.sigma_velocity);
  visit("evpt.sigma_rate", o.photometric.sigma_rate);
  visit("evpt.min_correlation", o.photometric.min_correlation);
  visit("evpt.max_bad_s", o.photometric.max_bad_s);
}

// visit(member) of the option at `path`.
template <typename Options, typename Visitor>
void VisitOption(Options& o, const std::string& path, const Visitor& visit) {
  bool found = false;
  VisitOptions(o, [&](const char* here, auto& member) {
    if (path != here) return;
    found = true;
    visit(member);
  });
  if (!found) throw std::logic_error("there is no option " + path);
}

// What holds a member's value in a SettingValue.
template <typename Member>
using Held =
    std::conditional_t<std::is_same_v<Member, bool> || std::is_same_v<Member, double>, Member, std::int64_t>;

}  // namespace

std::vector<std::string> OptionPaths() {
  std::vector<std::string> paths;
  const PipelineOptions options;
  VisitOptions(options, [&](const char* path, const auto&) { paths.emplace_back(path); });
  return paths;
}

std::vector<const void*> OptionAddresses(const PipelineOptions& options) {
  std::vector<const void*> addresses;
  VisitOptions(options, [&](const char*, const auto& member) { addresses.push_back(&member); });
  return addresses;
}

SettingValue GetOption(const PipelineOptions& options, const std::string& path) {
  SettingValue value;
  VisitOption(options, path,
              [&](const auto& member) { value = static_cast<Held<std::decay_t<decltype(member)>>>(member); });
  return value;
}

void SetOption(const std::string& path, const SettingValue& value, PipelineOptions* options) {
  VisitOption(*options, path, [&](auto& member) {
    using Member = std::decay_t<decltype(member)>;
    member = static_cast<Member>(std::get<Held<Member>>(value));
  });
}

}  // namespace evit
