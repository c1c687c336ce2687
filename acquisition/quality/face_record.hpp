#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "acquisition/quality/face_change.hpp"
#include "acquisition/quality/face_print.hpp"

namespace biotomy::acquisition {

/// What a new face is compared with: the last accepted layer's, how much the faces before it
/// changed, and the frames that the camera gave last. Cheap to copy.
class FaceRecord {
 public:
  /// Fewer recent changes than this say nothing of how much a face changes here.
  static constexpr std::size_t kEnough = 3;
  /// So many layers' changes are remembered.
  static constexpr std::size_t kRemembered = 16;

  /// The layer is accepted and stored. `change` is what it was found to have changed.
  void accept(std::int64_t layer, std::shared_ptr<const FacePrint> face, const FaceChange& change);

  /// A layer's change that is known from the journal, in the order of the layers.
  void recall(double change);

  /// A frame was taken, good or not.
  void saw(const FacePrint& frame);

  std::int64_t layer() const { return layer_; }  ///< whose face it is; 0 for none
  const FacePrint* face() const { return face_.get(); }

  /// Of the frames taken last, whatever became of them.
  const std::deque<std::shared_ptr<const FrameRows>>& recent_frames() const { return frames_; }

  /// The least of the recent changes of the whole face; of a row or a column of patches. Nothing
  /// while there are not enough. The least and not the mean: what changes slowly, as a muscle whose
  /// fibres run across the layers, sets the limit, not what changed fast before it.
  std::optional<double> least_change() const;
  std::optional<double> least_change_of_row(std::size_t row) const;
  std::optional<double> least_change_of_column(std::size_t column) const;

 private:
  using History = std::deque<double>;

  std::int64_t layer_ = 0;
  std::shared_ptr<const FacePrint> face_;
  History whole_;
  std::vector<History> rows_;
  std::vector<History> columns_;
  std::deque<std::shared_ptr<const FrameRows>> frames_;
};

}  // namespace biotomy::acquisition
