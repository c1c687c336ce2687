#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace biotomy::tests {

/// What a sample's journal says of a run, read by SQL of our own. Times are ISO 8601, UTC.
struct RunJournal {
  struct Grind {
    std::uint32_t sequence = 0;
    std::int64_t layer = 0;
    double target_um = 0.0;
    std::string intended_at;
  };
  struct Attempt {
    std::int64_t layer = 0;
    int attempt = 0;
    std::uint64_t frame = 0;
    std::string taken_at;
    std::string verdict;
  };
  struct Layer {
    std::int64_t layer = 0;
    int attempt = 0;
    std::string file;  ///< relative to the sample
    std::uint64_t bytes = 0;
    std::string sha256;
    std::string committed_at;
  };
  struct Search {
    std::string at;  ///< its end
    std::int64_t layer = 0;
    std::vector<double> columns_um;
  };
  /// A frame that was taken to see whether the camera works.
  struct Trial {
    std::string at;
    std::uint64_t frame = 0;
  };
  struct Alarm {
    std::string at;
    std::string state;  ///< in which it came
    std::string cause;
  };

  std::vector<Grind> grinds;      ///< by number
  std::vector<Attempt> attempts;  ///< in the order in which they were recorded
  std::vector<Layer> layers;      ///< by section number
  std::vector<Search> searches;
  std::vector<Trial> trials;
  std::vector<Alarm> alarms;
  std::vector<std::string> no_frame_at;  ///< when the camera had been asked and gave none
};

/// Of a copy, so that what a killed daemon left is mended by the daemon and not by the reader. A
/// journal that is not there, or without tables yet, says nothing. Throws std::runtime_error when
/// it cannot be read.
RunJournal read_run_journal(const std::filesystem::path& journal);

}  // namespace biotomy::tests
