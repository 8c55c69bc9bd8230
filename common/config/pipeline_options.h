#pragma once

#include "common/events/keyframe_options.h"
#include "common/events/surface_options.h"
#include "common/photometric/photometric_options.h"
#include "common/tracking/tracker_options.h"

namespace evit {

/// Everything a settings file says. Each part belongs to the class that uses it; defaults are EVIT's.
struct PipelineOptions {
  enum class Method {
    kEvit,  // the window: events and IMU
    kEvt,   // each frame localised by its events alone, no IMU; with the previous pose the paper's baseline
    kEvpt   // the paper's other baseline: events against brightness changes predicted from a photometric map;
            // no IMU
  };
  Method method = Method::kEvit;
  KeyframeOptions keyframes;
  SurfaceOptions surface;
  PointOptions points;
  WindowOptions window;
  BootstrapOptions bootstrap;
  FailureOptions failure;
  PhotometricOptions photometric;
};

/// The part that a tracker with a map of points needs (MakeTracker).
inline TrackerOptions TrackerPart(const PipelineOptions& o) {
  return {o.points,
          o.window,
          o.bootstrap,
          o.failure,
          o.keyframes.min_events,
          o.surface.lag_px,
          o.method == PipelineOptions::Method::kEvt};
}

/// What is in force where a settings file says nothing but the method. EVT predicts nothing, as in the paper.
inline PipelineOptions DefaultsOf(PipelineOptions::Method method) {
  PipelineOptions options;
  options.method = method;
  if (method == PipelineOptions::Method::kEvt)
    options.window.motion_model = WindowOptions::MotionModel::kPreviousPose;
  // Images say nothing of how patches of the map lie beside them: a shift of 1.5 mm of every view, simulated.
  if (method == PipelineOptions::Method::kEvpt)
    options.window.map_sigma_m = PhotometricTrackerOptions().map_sigma_m;
  return options;
}

}  // namespace evit
