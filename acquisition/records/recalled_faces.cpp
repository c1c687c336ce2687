#include "acquisition/records/recalled_faces.hpp"

#include <algorithm>
#include <memory>

#include "acquisition/quality/face_judgement.hpp"
#include "acquisition/records/journal_reader.hpp"

namespace biotomy::acquisition {

FaceRecord recall_faces(const reconstruct::SampleFolder& sample, std::int64_t last_committed,
                        const std::function<cv::Mat(const std::filesystem::path&)>& read_layer) {
  FaceRecord faces;
  if (last_committed < 1) return faces;

  constexpr std::int64_t kLayers = FaceRecord::kRemembered;
  const std::int64_t first = std::max<std::int64_t>(1, last_committed - kLayers + 1);
  const JournalReader journal(sample.journal_path());
  for (const LayerRow& layer : journal.committed_layers(first, kLayers)) {
    for (const Metric& metric : layer.metrics) {
      if (metric.name == kFaceChange) faces.recall(metric.value);
    }
  }
  const auto face = std::make_shared<const FacePrint>(
      take_face_print(read_layer(sample.layer_path(last_committed))));
  faces.saw(*face);
  faces.accept(last_committed, face, {});
  return faces;
}

}  // namespace biotomy::acquisition
