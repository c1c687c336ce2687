#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include <opencv2/core/mat.hpp>

#include "acquisition/quality/face_record.hpp"
#include "acquisition/quality/sharpness_record.hpp"
#include "acquisition/quality/surface_record.hpp"
#include "reconstruct/sample/sample_folder.hpp"

namespace biotomy::acquisition {

struct RecalledFaces {
  FaceRecord faces;
  SharpnessRecord sharpness;
  SurfaceRecord surfaces;
};

/// What a job that goes on behind this layer must know of the faces up to it: `read_layer` reads
/// its image (for the sharpness the last one's without a flag), the journal says how much the faces
/// changed, the first layer's casting material and the camera's noise. Without a journal, as after
/// an import, no layer has a flag, and the first images tell the casting material. Nothing without
/// layers. Throws JournalError, SampleError for a damaged image.
RecalledFaces recall_faces(const reconstruct::SampleFolder& sample, std::int64_t last_committed,
                           const std::function<cv::Mat(const std::filesystem::path&)>& read_layer);

}  // namespace biotomy::acquisition
