#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace biotomy::tests {

/// A moment at which daemon, twin or both had been killed and were not running yet again.
struct Killed {
  std::string at;              ///< ISO 8601, UTC
  std::int64_t committed = 0;  ///< layers that the journal held then
};

/// A run that has come to its end: what was asked for, and what it left behind.
struct FinishedRun {
  std::filesystem::path witness;
  std::filesystem::path sample;
  std::int64_t layers = 0;
  double first_face_um = 0.0;
  double layer_thickness_um = 0.0;
  std::vector<Killed> kills;  ///< in their order
  /// The camera takes frames all the time and counts them by itself: the twin's are not recorded
  /// one by one. And they come by JPEG.
  bool camera_streams = false;

  double face_um(std::int64_t layer) const {
    return first_face_um + static_cast<double>(layer - 1) * layer_thickness_um;
  }
};

/// What was wrong with a run, a sentence each; nothing when it was right. Right means:
/// - every layer was ground by exactly one whole pass, in order. A pass that was broken off by a
///   kill, a fault or an alarm is followed by a whole one to the same target;
/// - no pass began before the layer above was committed: by the clock, and, whatever the clock
///   says, by what the journal held at each kill. Every pass was in the journal before it began;
/// - every layer is committed and its file is there with its hash;
/// - its photograph was taken of its own face, by the lamp's light, and shows what an undisturbed
///   run's layer shows, by far better than that layer's neighbours do;
/// - every frame that the twin took, unless the camera streams, is in the journal: as an attempt,
///   as a point of a focus search, as a trial of the camera, or as one that did not arrive. A kill
///   loses the frame on its way, and the record of the search that it breaks off.
std::vector<std::string> judge(const FinishedRun& run,
                               const std::filesystem::path& undisturbed_sample);

}  // namespace biotomy::tests
