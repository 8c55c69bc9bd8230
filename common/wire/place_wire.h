#pragma once

#include <vector>

#include "common/geometry/rig.h"
#include "common/localization/place_query.h"
#include "evit/place_prior_t.hpp"
#include "evit/place_query_t.hpp"
#include "evit/places_t.hpp"

/// Questions for places and their answers. Incoming messages must have been checked (DecodeChecked); utime of
/// the answer, seq and epoch are the caller's.
namespace evit {

place_prior_t ToMessage(const PlacePrior& prior);
PlacePrior FromMessage(const place_prior_t& message);

/// `rig`: what the keyframe was seen with.
place_query_t ToMessage(const PlaceQuery& query, const Rig& rig);
PlaceQuery FromMessage(const place_query_t& message);
/// Camera and T_body_camera of the question; nothing else of the rig.
Rig RigOf(const place_query_t& message);

places_t ToMessage(const std::vector<PlaceCandidate>& places);
std::vector<PlaceCandidate> PlacesOf(const places_t& message);

}  // namespace evit
