#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>

#include <libcamera/camera.h>
#include <libcamera/pixel_format.h>

#include "firmware_bridge/camera/bayer.hpp"
#include "firmware_bridge/camera/libcamera_camera.hpp"
#include "firmware_bridge/camera/pixel_formats.hpp"
#include "firmware_bridge/wire/transfer.hpp"

namespace biotomy::bridge {

/// What a camera delivers: finished colours, or a sensor's raw values.
using FrameFormat = std::variant<PixelFormat, BayerFormat>;

/// The model that a camera says it is, or else its id.
std::string model_of(const libcamera::Camera& camera);

/// Our name for a pixel format of libcamera; none for one that we don't read.
std::optional<FrameFormat> known_format(const libcamera::PixelFormat& format);

/// How the values of frames in a format follow the light. Raw values are coded by us; of finished
/// colours libcamera does not tell what its tuning made of them, and they are taken for sRGB, as
/// viewers take them.
Transfer transfer_of(const libcamera::PixelFormat& format, bool raw_is_srgb);

/// How a YUV stream codes its colours, as far as it tells.
YuvCoding coding_of(const libcamera::StreamConfiguration& stream);

/// A configuration of a still stream as the settings ask for it, and beside it, if they ask for one
/// and the pipeline can, of a small stream for a viewfinder: the named format, or the best of those
/// we read (finished colours before raw values, uncompressed ones first); the given size, or the
/// largest. Validated, not applied. Throws DeviceError (configuration) if the camera can't do it,
/// or only something else.
std::unique_ptr<libcamera::CameraConfiguration> choose_configuration(
    libcamera::Camera& camera, const LibcameraSettings& settings);

}  // namespace biotomy::bridge
