#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>

#include <opencv2/core/mat.hpp>

#include "firmware_bridge/camera/camera.hpp"

namespace biotomy::acquisition {

/// A calibration that cannot be recorded, read or used; the message says what to do.
class CalibrationError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A frame that others are corrected by: the mean of several, and how they were taken. Only frames
/// that are taken likewise can be corrected by it.
struct CalibrationFrame {
  cv::Mat mean;  ///< of the light, CV_16UC3, R G B; 65535 is full scale, whatever the frames' bits
  int bits = 8;  ///< of the frames, 8 or 16
  int frames = 0;
  bridge::CameraSettings settings;
  std::string taken_at;  ///< ISO 8601, UTC
  std::string sha256;    ///< of the file that holds the mean; given by writing and reading
};

/// Which frames: with the lamp on and an even, pale surface in view, or with the lamp off.
enum class FieldKind { flat, dark };

const char* to_string(FieldKind kind);

/// As much of a hash as people are shown.
std::string short_hash(const std::string& sha256);

/// Writes it into the folder, which is made if need be, and gives its hash: the mean as
/// `flat-….tif`, then `flat.json`, which names it and holds the rest. Until that is on the disk,
/// the frame that was there before is in force. Afterwards it is kept, its `flat.json` under its
/// mean's name as `flat-….json`: a sample that was begun with it may have to be gone on with.
/// Throws CalibrationError.
std::string write_calibration_frame(const std::filesystem::path& folder, FieldKind kind,
                                    const CalibrationFrame& frame);

/// The one in force. The mean in a record that does not tell how it follows the light is of the
/// frames' own values, as earlier versions kept it, and `transfer` theirs. Throws CalibrationError
/// when there is none, and when it is damaged.
CalibrationFrame read_calibration_frame(const std::filesystem::path& folder, FieldKind kind,
                                        bridge::Transfer transfer);

}  // namespace biotomy::acquisition
