#include "acquisition/quality/surface_print.hpp"

#include "acquisition/quality/light_change.hpp"
#include "acquisition/quality/thumbnail.hpp"

namespace biotomy::acquisition {

SurfacePrint take_surface_print(const cv::Mat& image) {
  SurfacePrint print;
  print.thumbnail = take_thumbnail(image);
  if (print.thumbnail.empty()) return print;
  print.light = light_grid(print.thumbnail);
  print.colours = std::make_shared<const SurfaceColours>(surface_scale(print.thumbnail));
  print.border = take_border(image);
  return print;
}

}  // namespace biotomy::acquisition
