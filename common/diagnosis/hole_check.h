#pragma once

#include "common/diagnosis/assumptions.h"
#include "common/diagnosis/event_excerpts.h"
#include "common/diagnosis/finding.h"
#include "common/map/map_index.h"

namespace evit::diagnosis {

/// Does the map hold what fires? Pixels that fire beside others, as edges do, with no point of the map
/// anywhere near. Some are always left: edges too weak for the map, what moves by itself. On good recordings,
/// real and simulated, these are at most 20 % (mean over the views); more counts where it is more by two
/// standard errors of that mean, which chance reaches in one of forty recordings at 20 %. In the three worst
/// views of a good recording it is 26 % at most; more than a third there counts, too.
Finding CheckHoles(const MapIndex& map, const World& world, const EventExcerpts& excerpts);

}  // namespace evit::diagnosis
