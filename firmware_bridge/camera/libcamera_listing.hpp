#pragma once

#include <string>
#include <vector>

namespace biotomy::bridge {

/// A pixel format that a camera offers for stills.
struct ListedFormat {
  std::string name;  ///< as in camera.pixel_format: "BGR888", "NV12", "SRGGB10_CSI2P" …
  bool is_readable = false;
  std::vector<std::string> sizes;  ///< "4056x3040", or a range "(16x16)-(4056x3040)/(+2,+2)"
};

/// A control of a camera, its values as text.
struct ListedControl {
  std::string name;  ///< libcamera's: "ExposureTime"
  std::string least;
  std::string most;
  std::string usual;
};

/// A camera that libcamera knows, and what it can do.
struct ListedCamera {
  std::string id;
  std::string model;
  std::vector<ListedFormat> formats;
  std::vector<ListedControl> controls;
  std::string trouble;  ///< why it could not be asked, in words; empty when it could
};

/// The version of libcamera in use: "v0.0.3…".
std::string libcamera_version();

/// The cameras there are now; often none. One that another program has acquired is listed all the
/// same. Throws DeviceError if libcamera can't start.
std::vector<ListedCamera> list_libcamera_cameras();

}  // namespace biotomy::bridge
