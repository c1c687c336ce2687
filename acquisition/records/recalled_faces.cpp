#include "acquisition/records/recalled_faces.hpp"

#include <algorithm>
#include <memory>

#include "acquisition/quality/face_judgement.hpp"
#include "acquisition/records/journal_reader.hpp"

namespace biotomy::acquisition {

RecalledFaces recall_faces(const reconstruct::SampleFolder& sample, std::int64_t last_committed,
                           const std::function<cv::Mat(const std::filesystem::path&)>& read_layer) {
  RecalledFaces recalled;
  if (last_committed < 1) return recalled;

  constexpr std::int64_t kLayers = FaceRecord::kRemembered;
  const std::int64_t first = std::max<std::int64_t>(1, last_committed - kLayers + 1);
  const JournalReader journal(sample.journal_path());
  for (const LayerRow& layer : journal.committed_layers(first, kLayers)) {
    for (const Metric& metric : layer.metrics) {
      if (metric.name == kFaceChange) recalled.faces.recall(metric.value);
    }
  }
  const cv::Mat image = read_layer(sample.layer_path(last_committed));
  const auto face = std::make_shared<const FacePrint>(take_face_print(image));
  recalled.faces.saw(*face);
  recalled.faces.accept(last_committed, face, {});
  recalled.sharpness.accept(std::make_shared<const FrameMeasures>(measure_frame(image)));
  return recalled;
}

}  // namespace biotomy::acquisition
