#include "acquisition/quality/face_record.hpp"

#include <algorithm>
#include <utility>

namespace biotomy::acquisition {
namespace {

constexpr std::size_t kFrames = 6;  // a camera has no more buffers that it might give again

void remember(std::deque<double>& history, double change) {
  history.push_back(change);
  if (history.size() > FaceRecord::kRemembered) history.pop_front();
}

void remember_lines(std::vector<std::deque<double>>& histories,
                    const std::vector<std::optional<Change>>& lines) {
  histories.resize(std::max(histories.size(), lines.size()));
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i]) remember(histories[i], lines[i]->value);
  }
}

std::optional<double> least(const std::deque<double>& history) {
  if (history.size() < FaceRecord::kEnough) return std::nullopt;
  return *std::ranges::min_element(history);
}

std::optional<double> least_of(const std::vector<std::deque<double>>& histories, std::size_t line) {
  return line < histories.size() ? least(histories[line]) : std::nullopt;
}

}  // namespace

void FaceRecord::accept(std::int64_t layer, std::shared_ptr<const FacePrint> face,
                        const FaceChange& change) {
  layer_ = layer;
  face_ = std::move(face);
  if (change.whole) remember(whole_, change.whole->value);
  remember_lines(rows_, change.rows);
  remember_lines(columns_, change.columns);
}

void FaceRecord::recall(double change) {
  remember(whole_, change);
}

void FaceRecord::saw(const FacePrint& frame) {
  frames_.push_back(frame.frame_rows);
  if (frames_.size() > kFrames) frames_.pop_front();
}

std::optional<double> FaceRecord::least_change() const {
  return least(whole_);
}

std::optional<double> FaceRecord::least_change_of_row(std::size_t row) const {
  return least_of(rows_, row);
}

std::optional<double> FaceRecord::least_change_of_column(std::size_t column) const {
  return least_of(columns_, column);
}

}  // namespace biotomy::acquisition
