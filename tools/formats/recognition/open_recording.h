#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tools/formats/import/recording.h"

namespace evit::formats {

/// What can be chosen where a recording holds several streams of a kind; empty: the only one.
struct StreamChoice {
  std::string events, imu, truth;  // topics
  std::string truth_frame;         // of a topic of TFMessage
  // False: it is taken from another file, so that several of its kind are no question here.
  bool take_events = true, take_imu = true, take_truth = true;
};

/// Opens a recording of whatever format, which it recognises by the contents of its files, not by their
/// names. Several paths: parts of one recording, where the format has such. Throws std::runtime_error naming
/// the file, what it is recognised as, and what to do.
std::unique_ptr<Recording> OpenRecording(const std::vector<std::string>& paths,
                                         const StreamChoice& choice = {});

/// Whether a file or folder is a recording that OpenRecording would recognise as binary, by itself.
bool IsRecording(const std::string& path);

/// Whether StreamChoice chooses truth in it: bags.
bool HasTruthTopics(const std::string& path);
/// Whether it chooses an IMU in it: bags, AEDAT 4.
bool HasImuTopics(const std::string& path);

/// The size of a sensor that its recording does not name: the smallest known one that holds all its events.
/// Reads them all.
void MeasureSize(Recording* recording, int* width, int* height);

}  // namespace evit::formats
