#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <opencv2/core/mat.hpp>

#include "acquisition/records/layer_journal.hpp"
#include "reconstruct/sample/sample_folder.hpp"
#include "tests/faults/run_judge.hpp"

namespace biotomy::tests {

/// A run as daemon and twin would leave it, written down event by event, a second each.
class MadeUpRun {
 public:
  static constexpr int kLayers = 4;
  static constexpr double kFirstFaceUm = 1000.0;
  static constexpr double kThicknessUm = 20.0;

  static double face_um(std::int64_t layer);

  /// What a layer shows: coarse shapes of its own, and the noise of one photograph.
  static cv::Mat photograph(std::int64_t layer, int noise);

  static reconstruct::SampleFolder new_sample(const std::filesystem::path& folder);

  explicit MadeUpRun(const std::filesystem::path& folder);

  std::string now();
  void witness(const char* event, nlohmann::json facts);
  void start_twin(const char* result);

  void intend(std::int64_t layer);
  void begin_pass(std::int64_t layer);
  void end_pass(const char* result);
  void grind(std::int64_t layer);  ///< the three of them

  void move_column();
  void take_frame(std::int64_t layer, double column_um = 650.0, bool spoilt = false);
  void photograph_in_the_dark() { lamp_on_ = false; }

  /// Of a picture that came under a number which is not that of the last capture.
  void reject(std::int64_t layer, std::uint64_t frame);

  /// Of the last capture; the image is of the layer `shown`.
  void commit(std::int64_t layer, std::int64_t shown);
  void commit(std::int64_t layer) { commit(layer, layer); }

  void make(std::int64_t layer);       ///< ground, photographed and committed
  void make_from(std::int64_t layer);  ///< to the last

  void record_search(std::int64_t layer, const std::vector<double>& columns_um);
  void note(const char* kind, const char* text, const char* state = "preflight");
  void alarm(const char* state) { note("alarm", "made up", state); }
  void kill(std::int64_t committed) { kills_.push_back({now(), committed}); }

  const reconstruct::SampleFolder& sample() const { return sample_; }
  FinishedRun finished() const;

 private:
  std::filesystem::path folder_;
  reconstruct::SampleFolder sample_;
  acquisition::LayerJournal journal_;
  int second_ = 0;
  std::uint32_t sequence_ = 0;
  int frame_ = 0;
  int noise_ = 0;
  int attempt_ = 0;
  bool lamp_on_ = true;
  std::vector<Killed> kills_;
};

}  // namespace biotomy::tests
