#pragma once

#include "common/photometric/photometric_view.h"
#include "evit/map_view_t.hpp"
#include "evit/view_query_t.hpp"

/// Views of a photometric map as messages. Incoming messages must have been checked (DecodeChecked); utime,
/// seq and epoch are the caller's.
namespace evit {

view_query_t ToMessage(const ViewQuery& query);
ViewQuery FromMessage(const view_query_t& message);

/// Rounded to 1/4096 of log intensity and 1 / (65535 * min_depth) of inverse depth: 1e-4 and, at 2 m with
/// min_depth 0.1 m, 0.6 mm. Depths nearer than min_depth are cut off there.
map_view_t ToMessage(const PhotometricView& view);
/// `query`: the one it answers.
PhotometricView FromMessage(const map_view_t& message, const ViewQuery& query);

}  // namespace evit
