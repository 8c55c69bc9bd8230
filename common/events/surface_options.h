#pragma once

namespace evit {

/// How a time surface is drawn (paper Sec. III-B.2).
struct SurfaceOptions {
  enum class Kind {
    kCausal,    // the paper's: only events before the keyframe's stamp; lags one to two pixels behind moving
                // edges
    kSymmetric  // the event nearest in time, before or after: no lag, at the price of `lookahead_ms` of
                // latency
  };
  Kind kind = Kind::kSymmetric;
  double lookahead_ms = 40;  // symmetric: how far events after the stamp count, at most
  double tail_px = 1;        // decay = tail_px / image speed (the tracker's figure), within the bounds below
  double min_decay_ms = 2;
  double max_decay_ms = 60;
  double default_decay_ms = 15;  // while the image speed is unknown
  double truncation = 40;      // grey levels 0..255 of the (not negated) surface; older events count as none
  double blur_sigma_px = 1;    // Gaussian blur
  bool support_filter = true;  // only pixels with a neighbour that fired too: background noise is left out
  double lag_px = 0.25;        // how far events are behind the edges that cause them
  double hot_pixel_rate_hz = 100;  // events/s of a defect pixel, at least; such pixels are left out. 0: off
};

}  // namespace evit
