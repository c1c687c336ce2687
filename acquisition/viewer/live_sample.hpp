#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>

#include "reconstruct/bricks/opened_sample.hpp"
#include "reconstruct/bricks/volume_bricks.hpp"

namespace biotomy::acquisition {

/// A sample as it was at one moment, with the chunks that were read of it.
struct SampleView {
  reconstruct::OpenedSample sample;
  mutable reconstruct::VolumeBricks bricks;  ///< safe for many threads
  std::uint64_t generation = 0;

  SampleView(const std::filesystem::path& folder, std::size_t cache_bytes);

  /// Takes over what `before`, a view of the same volume, has read of it.
  SampleView(const std::filesystem::path& folder, std::size_t cache_bytes,
             const SampleView& before);
};

/// A sample that is kept open for pictures while it grows: opened anew when its description, its
/// volume's metadata or the layers on disk have changed, and only then. Safe for many threads.
class LiveSample {
 public:
  /// The folder need not be there yet.
  LiveSample(const std::filesystem::path& folder, std::size_t cache_bytes);

  const std::filesystem::path& folder() const { return folder_; }

  /// Whether there is a sample yet.
  bool is_there() const;

  /// The sample as it is now. Throws SampleError where it is none or cannot be read.
  std::shared_ptr<const SampleView> look();

  /// Grows with every change, also from one program to the next. Reads no image and no chunk.
  std::uint64_t generation();

 private:
  void refresh();

  std::filesystem::path folder_;
  std::size_t cache_bytes_;
  std::mutex mutex_;
  std::string files_;   // what the view was opened by
  std::string volume_;  // which folder the volume was: one that is made anew is another
  std::uint64_t generation_;
  std::shared_ptr<const SampleView> view_;  // none where it could not be opened
};

}  // namespace biotomy::acquisition
