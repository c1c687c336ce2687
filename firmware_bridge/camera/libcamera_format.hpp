#pragma once

#include <optional>

#include <libcamera/camera.h>
#include <libcamera/pixel_format.h>

#include "firmware_bridge/camera/libcamera_camera.hpp"
#include "firmware_bridge/camera/pixel_formats.hpp"

namespace biotomy::bridge {

/// Our name for a pixel format of libcamera; none for one that we don't read.
std::optional<PixelFormat> known_format(const libcamera::PixelFormat& format);

/// Whether the numbers of a YUV stream go from 0 to 255.
YuvRange range_of(const libcamera::StreamConfiguration& stream);

/// A configuration of one still stream as the settings ask for it: the named format, or the best
/// of those we read (uncompressed colour first); the given size, or the largest. Validated, not
/// applied. Throws DeviceError (configuration) if the camera can't do it, or only something else.
std::unique_ptr<libcamera::CameraConfiguration> choose_configuration(
    libcamera::Camera& camera, const LibcameraSettings& settings);

}  // namespace biotomy::bridge
