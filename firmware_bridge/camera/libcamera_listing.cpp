#include "firmware_bridge/camera/libcamera_listing.hpp"

#include <algorithm>

#include <libcamera/camera_manager.h>
#include <libcamera/stream.h>

#include "firmware_bridge/camera/libcamera_format.hpp"
#include "firmware_bridge/camera/libcamera_manager.hpp"

namespace biotomy::bridge {

namespace {

void add_formats(const libcamera::StreamFormats& formats, ListedCamera& listed) {
  for (const libcamera::PixelFormat& format : formats.pixelformats()) {
    const std::string name = format.toString();
    const bool is_listed =
        std::any_of(listed.formats.begin(), listed.formats.end(),
                    [&](const ListedFormat& earlier) { return earlier.name == name; });
    if (is_listed) continue;
    ListedFormat entry{.name = name, .is_readable = known_format(format).has_value(), .sizes = {}};
    for (const libcamera::Size& size : formats.sizes(format)) {
      entry.sizes.push_back(size.toString());
    }
    if (entry.sizes.empty()) entry.sizes.push_back(formats.range(format).toString());
    listed.formats.push_back(std::move(entry));
  }
}

ListedCamera listed_camera(libcamera::Camera& camera) {
  ListedCamera listed{
      .id = camera.id(), .model = model_of(camera), .formats = {}, .controls = {}, .trouble = {}};
  for (const auto role : {libcamera::StreamRole::StillCapture, libcamera::StreamRole::Raw}) {
    const auto configuration = camera.generateConfiguration({role});
    if (!configuration || configuration->empty()) continue;
    add_formats(configuration->at(0).formats(), listed);
  }
  if (listed.formats.empty()) listed.trouble = "it does not tell what formats it has";
  for (const auto& [id, range] : camera.controls()) {
    listed.controls.push_back({.name = id->name(),
                               .least = range.min().toString(),
                               .most = range.max().toString(),
                               .usual = range.def().toString()});
  }
  std::sort(listed.controls.begin(), listed.controls.end(),
            [](const ListedControl& a, const ListedControl& b) { return a.name < b.name; });
  return listed;
}

}  // namespace

std::string libcamera_version() {
  return libcamera::CameraManager::version();
}

std::vector<ListedCamera> list_libcamera_cameras() {
  const auto manager = shared_camera_manager();
  std::vector<ListedCamera> listed;
  for (const auto& camera : manager->cameras()) listed.push_back(listed_camera(*camera));
  return listed;
}

}  // namespace biotomy::bridge
