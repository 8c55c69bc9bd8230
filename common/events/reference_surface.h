#pragma once

#include <cstdint>
#include <vector>

#include "common/events/event.h"
#include "common/events/surface_options.h"

namespace evit {

/// The negated time surface as the paper defines it (Sec. III-B.2, Eq. (2)), in plain double precision: what
/// ActiveEventSurface and SurfaceRenderer compute fast, and what they are tested against.
class ReferenceSurface {
 public:
  /// Both sides in pixels. Of the options: truncation, support_filter and blur_sigma_px.
  ReferenceSurface(int width, int height, const SurfaceOptions& options);

  /// Consecutive events [begin, end), all inside the image: the surface of active events, t_last of Eq. (2).
  void Update(const EventArray& events, std::size_t begin, std::size_t end);

  /// Grey levels 0 (event at t) .. 255 (none), row-major [height][width], at the instant t (us) up to which
  /// events were given. Events [begin, end) of `after` come later and count as well (symmetric surface).
  /// decay_us: delta of Eq. (2), us.
  std::vector<double> Render(Utime t, double decay_us, const EventArray& after = {}, std::size_t begin = 0,
                             std::size_t end = 0) const;

 private:
  std::size_t At(int x, int y) const { return static_cast<std::size_t>(y) * width_ + x; }
  bool Supported(const std::vector<double>& distance, double reach, int x, int y) const;
  std::vector<double> Blurred(const std::vector<double>& image, bool along_x) const;

  int width_, height_;
  SurfaceOptions options_;
  std::vector<double> last_;  // us: the newest event of each pixel
};

}  // namespace evit
