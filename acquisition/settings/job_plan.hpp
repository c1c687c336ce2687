#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>

#include "firmware_bridge/camera/camera.hpp"
#include "firmware_bridge/micrometres.hpp"
#include "reconstruct/sample/layer_image.hpp"
#include "reconstruct/store/volume_layout.hpp"

namespace biotomy::acquisition {

/// What is to be ground and photographed.
struct JobPlan {
  std::filesystem::path sample;  ///< the sample folder
  std::string name;
  std::string notes;
  std::int64_t layers = 1;
  bridge::Micrometres layer_thickness{20.0};
  bridge::Micrometres pixel_x{10.0};
  bridge::Micrometres pixel_y{10.0};
  bridge::Micrometres first_face{};  ///< feed position to which layer 1 is ground
  int bits = 8;                      ///< of one colour in a frame, 8 or 16
  double spindle_rpm = 1500.0;
  std::chrono::milliseconds clear_duration{1000};
  std::chrono::milliseconds settle_duration{500};
  std::chrono::milliseconds lamp_warm_up{200};
  /// When the daemon starts and the job was running when the last one ended.
  enum class AfterRestart { wait, go_on } after_restart = AfterRestart::wait;

  /// The feed position to which layer `layer`, from 1, is ground.
  bridge::Micrometres face_of(std::int64_t layer) const {
    return first_face + static_cast<double>(layer - 1) * layer_thickness;
  }
};

struct CameraPlan {
  bridge::CameraSettings settings;
  std::chrono::milliseconds capture_time_out{5000};
};

/// How layers, rejected frames and the volume are kept.
struct StorePlan {
  reconstruct::LayerFormat layer_format;
  reconstruct::VolumeLayout volume_layout;
  int rejected_frames = 500;     ///< kept at most
  int rejected_width_px = 1000;  ///< and height, at most
};

}  // namespace biotomy::acquisition
