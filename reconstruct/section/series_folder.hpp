#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <opencv2/core/mat.hpp>

#include "reconstruct/disk/file_descriptor.hpp"

namespace biotomy::reconstruct {

/// A series and its frames on disk, one process at a time: `series.json` says what the series is,
/// and each frame is a picture file. Frames that an interrupted run left are kept, if they belong
/// to the very same series; nothing of another one is ever touched or taken for it. Frames that
/// show background in the place of damage stand in `damaged.json`, and are cut again the next time.
class SeriesFolder {
 public:
  /// Makes the folder, or takes the series in it up again. `description` is all that makes the
  /// series what it is; `frames` are the names of its files. Films (.mp4) may lie there too.
  /// Its member `sample`, with a `name`, is the state of the sample; if that alone is another one,
  /// the message says so.
  /// Throws SampleError when the folder holds another series or files that are none of ours, when
  /// another process is working in it, or when it can't be written to.
  SeriesFolder(std::filesystem::path path, const nlohmann::ordered_json& description,
               std::vector<std::string> frames);

  /// A frame that is there, whole and of this size and type; none where it has yet to be cut.
  std::optional<cv::Mat> frame(std::size_t index, cv::Size size, int type) const;

  /// Has `write` write a frame. `is_damaged`: it lacks what is damaged in the volume. Throws
  /// SampleError, and what `write` throws.
  void store(std::size_t index, bool is_damaged,
             const std::function<void(const std::filesystem::path&)>& write);

 private:
  void remove_leftovers() const;
  void refuse_strangers() const;
  void read_damaged();
  void write_damaged() const;

  std::filesystem::path path_;
  std::vector<std::string> frames_;
  FileDescriptor lock_;
  std::set<std::string> damaged_;  ///< names of frames
};

}  // namespace biotomy::reconstruct
