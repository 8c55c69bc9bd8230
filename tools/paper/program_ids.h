#pragma once

#include <string>

namespace evit::paper {

/// Tells one build of the code that makes recordings (simulator, imports) from another: changes of it, and of
/// nothing else, make recordings again.
std::string RecordingProgramId();

/// The same of the code that makes photometric maps of their images.
std::string PhotometricProgramId();

/// The same of the code that tracks: the services beside `programs`/evit, and what runs them.
std::string TrackingProgramId(const std::string& programs);

}  // namespace evit::paper
