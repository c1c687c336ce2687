#include "tools/sweep_report.hpp"

#include <algorithm>
#include <iomanip>
#include <sstream>
#include <string>

#include <nlohmann/json.hpp>

#include "reconstruct/utf8.hpp"

namespace biotomy::tools {
namespace {

namespace fs = std::filesystem;
using acquisition::SweepFrame;
using acquisition::SweepRanking;

std::string text_of(double value, int decimals) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(decimals) << value;
  return text.str();
}

std::string conclusion(const std::vector<fs::path>& files, const SweepRanking& ranking) {
  const std::string name = files[ranking.sharpest].filename().string();
  std::string text = "sharpest: " + name;
  if (!ranking.certain) text += ", but noise alone could have put it first";
  if (ranking.peak) {
    text += "; the focus lies at frame " + text_of(*ranking.peak, 2) + ", counted from 0";
  } else {
    text += std::string("; it is the ") + (ranking.sharpest == 0 ? "first" : "last") +
            " frame: the focus may lie beyond the sweep";
  }
  return text;
}

}  // namespace

void print_sweep(std::ostream& out, const std::vector<fs::path>& files,
                 const SweepRanking& ranking) {
  std::size_t width = 5;
  for (const fs::path& file : files) width = std::max(width, file.filename().string().size());
  const auto name_width = static_cast<int>(width);
  out << std::left << std::setw(name_width) << "frame" << std::right
      << "   focus   error  tiles  clipped  brightness\n";
  for (std::size_t f = 0; f < files.size(); ++f) {
    const SweepFrame& frame = ranking.frames[f];
    out << std::left << std::setw(name_width) << files[f].filename().string() << std::right
        << std::setw(8) << text_of(frame.focus, 4) << std::setw(8) << text_of(frame.error, 4)
        << std::setw(7) << frame.sharpest_tiles << std::setw(9) << text_of(frame.clipped, 4)
        << std::setw(12) << text_of(frame.brightness, 3)
        << (f == ranking.sharpest ? "  <- sharpest" : "") << '\n';
  }
  out << conclusion(files, ranking) << '\n';
}

void print_sweep_json(std::ostream& out, const std::vector<fs::path>& files,
                      const SweepRanking& ranking) {
  using nlohmann::ordered_json;
  ordered_json frames = ordered_json::array();
  for (std::size_t f = 0; f < files.size(); ++f) {
    const SweepFrame& frame = ranking.frames[f];
    frames.push_back({{"file", reconstruct::utf8_text(files[f].string())},
                      {"focus", frame.focus},
                      {"error", frame.error},
                      {"sharpest_tiles", frame.sharpest_tiles},
                      {"clipped", frame.clipped},
                      {"brightness", frame.brightness}});
  }
  const ordered_json document = {
      {"frames", frames},
      {"sharpest", reconstruct::utf8_text(files[ranking.sharpest].filename().string())},
      {"sharpest_index", ranking.sharpest},
      {"certain", ranking.certain},
      {"peak_index", ranking.peak ? ordered_json(*ranking.peak) : ordered_json(nullptr)},
      {"detail_px", ranking.detail_px},
      {"usable", ranking.usable}};
  out << document.dump(2) << '\n';
}

}  // namespace biotomy::tools
