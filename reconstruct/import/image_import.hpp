#pragma once

#include <cstdint>
#include <functional>

#include "reconstruct/import/image_sequence.hpp"
#include "reconstruct/import/import_request.hpp"
#include "reconstruct/interruption.hpp"
#include "reconstruct/sample/sample_folder.hpp"

namespace biotomy::reconstruct {

/// Layers stored of all; called by one thread at a time.
using ImportProgress = std::function<void(std::int64_t done, std::int64_t total)>;

/// Makes a sample from photographs: the layer images, their hashes and the volume. Nothing is seen
/// at `output` until all of it is there: it grows in a hidden folder beside (see PartialImport).
/// When something goes wrong before a layer is stored nothing is left; later what was done is kept,
/// the message says so, and the same request goes on from there. However often it was interrupted,
/// the sample becomes the same byte for byte.
/// Reading, encoding and storing overlap. The number of images in memory is bounded by their bytes.
/// Throws InvalidRequest, SampleError, or Interrupted when `stop` asked for it.
SampleFolder import_images(const ImageSequence& images, const ImportRequest& request,
                           const ImportProgress& progress = {}, const StopRequested& stop = {});

}  // namespace biotomy::reconstruct
