#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <opencv2/core/mat.hpp>

#include "reconstruct/store/file_descriptor.hpp"

namespace biotomy::reconstruct {

/// A series and its frames on disk, one process at a time: `series.json` says what the series is,
/// and each frame is a picture file. Frames that an interrupted run left are kept, if they belong
/// to the very same series; nothing of another one is ever touched or taken for it.
class SeriesFolder {
 public:
  /// Makes the folder, or takes the series in it up again. `description` is all that makes the
  /// series what it is; `frames` are the names of its files. Films (.mp4) may lie there too.
  /// Throws SampleError when the folder holds another series or files that are none of ours, when
  /// another process is working in it, or when it can't be written to.
  SeriesFolder(std::filesystem::path path, const nlohmann::ordered_json& description,
               std::vector<std::string> frames);

  std::filesystem::path frame_path(std::size_t index) const { return path_ / frames_.at(index); }

  /// A frame that is there, whole and of this size and type; none where it has yet to be cut.
  std::optional<cv::Mat> frame(std::size_t index, cv::Size size, int type) const;

 private:
  void remove_leftovers() const;
  void refuse_strangers() const;

  std::filesystem::path path_;
  std::vector<std::string> frames_;
  FileDescriptor lock_;
};

}  // namespace biotomy::reconstruct
