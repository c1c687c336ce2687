#include "sim/service/configuration.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string>

namespace biotomy::sim {

namespace {

using bridge::CheckedTable;
using bridge::FlagKey;
using bridge::IntegerKey;
using bridge::NumberKey;
using bridge::TextKey;

constexpr double kFarUm = 1e6;  // a metre: no rig is larger

std::filesystem::path optional_path(const CheckedTable& table, const TextKey& key) {
  const std::string text = table.get(key);
  return text.empty() ? std::filesystem::path() : table.resolve(text);
}

void read_top(const CheckedTable& file, Configuration& c) {
  c.rig.seed = static_cast<std::uint64_t>(
      file.get(IntegerKey{.name = "seed",
                          .fallback = 1,
                          .minimum = 0,
                          .description = "of the specimen, the wear and the noise"}));
  c.rig.time_scale = file.get(NumberKey{.name = "time_scale",
                                        .fallback = 1,
                                        .minimum = 0.001,
                                        .maximum = 1000,
                                        .description = "seconds of the rig in a real second; the "
                                                       "watchdog and the heartbeat stay real"});
  c.state_file = optional_path(
      file, {.name = "state_file",
             .fallback = "",
             .may_be_empty = true,
             .description = "what a restart must not forget; empty: nothing is kept"});
  c.witness_log = optional_path(
      file, {.name = "witness_log",
             .fallback = "",
             .may_be_empty = true,
             .description = "what was physically done, JSON lines, appended; empty: none"});
}

bridge::Endpoint read_endpoint(const CheckedTable& table, const TextKey& key,
                               std::initializer_list<bridge::Endpoint::Scheme> schemes,
                               const char* form) {
  const std::string text = table.get(key);
  if (text.empty()) {
    return {};  // the reference page's placeholder
  }
  try {
    bridge::Endpoint endpoint = bridge::parse_endpoint(text);
    if (std::ranges::find(schemes, endpoint.scheme) != schemes.end()) {
      if (!endpoint.path.empty()) {
        endpoint.path = table.resolve(endpoint.path);
      }
      return endpoint;
    }
  } catch (const bridge::ConfigurationError& error) {
    table.reject(key.name, error.what());
  }
  table.reject(key.name, "\"" + text + "\" is not of the form " + form);
}

void read_stage(const CheckedTable& stage, Configuration& c) {
  c.stage_listen = read_endpoint(
      stage,
      {.name = "listen",
       .fallback = "tcp://127.0.0.1:1502",
       .description =
           "where the controller listens for Modbus: tcp://host:port, port 0 is any free "
           "one; or rtu://path, a serial device, or a link to a pseudo-terminal that "
           "is made there"},
      {bridge::Endpoint::Scheme::tcp, bridge::Endpoint::Scheme::rtu},
      "tcp://host:port or rtu://path");
  c.stage_serial = bridge::read_serial_format(stage);
  c.register_map = stage.resolve(stage.get(
      TextKey{.name = "register_map", .description = "the file with the registers to serve"}));
  ControllerSettings& controller = c.rig.controller;
  controller.watchdog_timeout = std::chrono::milliseconds(
      stage.get(IntegerKey{.name = "watchdog_timeout",
                           .fallback = 2000,
                           .unit = "ms",
                           .minimum = 0,
                           .maximum = 60000,
                           .description = "the master's heartbeat unchanged for so long: faulted; "
                                          "0: no watchdog"}));
  const auto number = [&](const char* name, double fallback, const char* unit, double least,
                          double most, const char* description) {
    return stage.get(NumberKey{.name = name,
                               .fallback = fallback,
                               .unit = unit,
                               .minimum = least,
                               .maximum = most,
                               .description = description});
  };
  const auto limit = [&](const char* name, double fallback, const char* description) {
    return number(name, fallback, "um", -kFarUm, kFarUm, description);
  };
  controller.feed_minimum_um = limit("feed_minimum", 0, "of the feed axis");
  controller.feed_maximum_um = limit("feed_maximum", 60000, "of the feed axis");
  controller.column_minimum_um = limit("column_minimum", 0, "of the column");
  controller.column_maximum_um = limit("column_maximum", 60000, "of the column");
  DriveLimits& drives = controller.drives;
  controller.boot_seconds =
      number("boot_time", controller.boot_seconds, "s", 0, 600, "from power to idle, in rig time");
  drives.still_s = number("stall_time", drives.still_s, "s", 0.1, 60,
                          "a drive that does not do as it is told for so long: fault 5");
  drives.following_error_um =
      number("following_error", drives.following_error_um, "um", 0.1, kFarUm,
             "so far from its target a resting axis is a drive's fault");
  drives.overload_percent = number("overload", drives.overload_percent, "%", 1, 1000,
                                   "of the spindle's rated torque: more is fault 6");
  drives.overload_s = number("overload_time", drives.overload_s, "s", 0, 60, "if it lasts");
  if (controller.feed_minimum_um >= controller.feed_maximum_um) {
    stage.reject("feed_maximum", "must be more than feed_minimum");
  }
  if (controller.column_minimum_um >= controller.column_maximum_um) {
    stage.reject("column_maximum", "must be more than column_minimum");
  }
}

void read_motion(const CheckedTable& motion, Configuration& c) {
  const auto number = [&](const std::string& name, double fallback, const char* unit, double least,
                          double most, const char* description) {
    return motion.get(NumberKey{.name = name,
                                .fallback = fallback,
                                .unit = unit,
                                .minimum = least,
                                .maximum = most,
                                .description = description});
  };
  const auto speed = [&](const char* name, double fallback, const char* description) {
    return number(name, fallback, "um/s", 1, kFarUm, description);
  };
  MechanicsSettings& machine = c.rig.mechanics;
  machine.feed.speed_um_s = speed("feed_speed", 2000, "of the wheel, up and down");
  machine.traverse.speed_um_s = speed("traverse_speed", 60000, "of the block, to and fro");
  machine.grinding_speed_um_s = speed("grinding_speed", 6000, "of the block under the wheel");
  machine.column.speed_um_s = speed("column_speed", 4000, "of the camera's column");
  const double settling_s =
      1e-3 * number("settling", 80, "ms", 0, 400, "from reaching a target to standing still on it");
  const auto read_axis = [&](const std::string& name, AxisSettings& axis, double backlash_um,
                             double overshoot_um) {
    axis.settling_s = settling_s;
    axis.backlash_um = number(name + "_backlash", backlash_um, "um", 0, 10000,
                              "play between the motor and what it moves");
    axis.overshoot_um =
        number(name + "_overshoot", overshoot_um, "um", 0, 40, "beyond a target, on arrival");
  };
  read_axis("feed", machine.feed, 2, 0.2);
  read_axis("traverse", machine.traverse, 2, 1);
  read_axis("column", machine.column, 3, 1);
  machine.spindle_acceleration_rpm_s =
      number("spindle_acceleration", 3000, "rpm/s", 1, 1e6, "of the wheel's spindle");
  c.rig.controller.spindle_maximum_rpm =
      number("spindle_maximum", 6000, "rpm", 1, 65535, "a faster grind pass is refused");
  c.rig.controller.lift_um =
      number("lift", 2000, "um", 1, kFarUm, "how far the wheel goes up to let the block pass");
  machine.vibration_decay_s = 1e-3 * number("vibration_decay", 300, "ms", 0, 60000,
                                            "time constant, once what shook the rig is over");
}

void read_wheel(const CheckedTable& wheel, Configuration& c) {
  c.rig.mechanics.wheel_wear_um_mm3 = wheel.get(NumberKey{
      .name = "wear",
      .fallback = 0.002,
      .unit = "um/mm3",
      .minimum = 0,
      .maximum = 1000,
      .description = "radius lost for what is ground away: the face stays higher by so much"});
  c.rig.mechanics.load_per_wear_um = wheel.get(
      NumberKey{.name = "load_per_wear",
                .fallback = 0.05,
                .unit = "1/um",
                .minimum = 0,
                .maximum = 100,
                .description = "share of the cutting load that a micrometre of wear adds"});
}

void read_thermal(const CheckedTable& thermal, Configuration& c) {
  const auto number = [&](const char* name, double fallback, const char* unit, double least,
                          double most, const char* description) {
    return thermal.get(NumberKey{.name = name,
                                 .fallback = fallback,
                                 .unit = unit,
                                 .minimum = least,
                                 .maximum = most,
                                 .description = description});
  };
  ClimateSettings& climate = c.rig.mechanics.climate;
  climate.chamber_c = number("chamber", -22, "degC", -190, 100, "what the cooler keeps");
  climate.chamber_band_c =
      number("chamber_band", 0.5, "degC", 0, 50, "so far above and below the cooler switches");
  climate.ambient_c = number("ambient", 20, "degC", -190, 100, "outside");
  climate.insulation_s =
      number("insulation", 1800, "s", 1, 1e6, "time constant towards the ambient");
  climate.cooling_c_s = number("cooling", 0.06, "degC/s", 0, 100, "by the cooler, while it is on");
  climate.block_below_chamber_c =
      number("block_below_chamber", 8, "degC", -100, 100, "by the holder's cold plate");
  climate.block_s = number("block_time", 60, "s", 1, 1e6, "time constant of the block");
  climate.grinding_c_s =
      number("grinding", 0.02, "degC/s", 0, 100, "by which the wheel warms the block");
}

void read_camera(const CheckedTable& camera, Configuration& c) {
  const auto number = [&](const char* name, double fallback, const char* unit, double least,
                          double most, const char* description) {
    return camera.get(NumberKey{.name = name,
                                .fallback = fallback,
                                .unit = unit,
                                .minimum = least,
                                .maximum = most,
                                .description = description});
  };
  const auto side = [&](const char* name, const char* description) {
    return static_cast<int>(camera.get(IntegerKey{.name = name,
                                                  .fallback = 1000,
                                                  .unit = "px",
                                                  .minimum = 16,
                                                  .maximum = 16384,
                                                  .description = description}));
  };
  c.camera_model = camera.get(
      TextKey{.name = "model", .fallback = "Biotomy twin", .description = "what it calls itself"});
  c.optics.view.width = side("width", "of a frame");
  c.optics.view.height = side("height", "of a frame");
  c.optics.view.pixel_um = number("pixel", 10, "um", 0.01, 1000, "a pixel's side, on the face");
  c.sensor.bits = camera.get(TextKey{.name = "bits",
                                     .fallback = "8",
                                     .choices = {"8", "16"},
                                     .description = "of a channel"}) == "16"
                      ? 16
                      : 8;
  c.sensor.mosaic = camera.get(FlagKey{
      .name = "mosaic",
      .fallback = false,
      .description = "it has one chip, whose pixels see red, green or blue; the other colours of "
                     "each are interpolated"});
  c.optics.lens.numerical_aperture =
      number("numerical_aperture", 0.1, "", 0.001, 0.9, "on the face's side: how fast it blurs");
  c.optics.lens.wavelength_um = number("wavelength", 0.55, "um", 0.3, 1.1, "for diffraction");
  c.optics.column_offset_um =
      number("column_offset", 350, "um", -kFarUm, kFarUm,
             "the focal plane's feed coordinate less the column's position; the daemon has to "
             "find it");
  c.optics.tilt.across_um =
      number("tilt_across", 0, "um", -kFarUm, kFarUm,
             "the face lies so much deeper at the right edge of the frame than at the left");
  c.optics.tilt.down_um =
      number("tilt_down", 0, "um", -kFarUm, kFarUm, "likewise at the lower edge than at the upper");
  c.sensor.nominal_exposure_us =
      1e3 * number("nominal_exposure", 10, "ms", 0.01, 10000, "shows true levels at gain 1");
  c.sensor.photons_at_white =
      number("photons_at_white", 16000, "", 10, 1e9, "behind level 255 at gain 1: their noise");
  c.sensor.read_noise_levels =
      number("read_noise", 0.5, "levels", 0, 50, "standard deviation, of 255 levels, at gain 1");
  c.sensor.vignetting = number("vignetting", 0.08, "", 0, 0.9, "share of light lost in a corner");
  c.sensor.stray_light = number("stray_light", 0.002, "", 0, 1, "share of light with the lamp off");
}

void read_block(const CheckedTable& block, Configuration& c) {
  const auto number = [&](const char* name, double fallback, const char* unit, double least,
                          double most, const char* description) {
    return block.get(NumberKey{.name = name,
                               .fallback = fallback,
                               .unit = unit,
                               .minimum = least,
                               .maximum = most,
                               .description = description});
  };
  c.first_face_um = number("first_face", 1000, "um", -kFarUm, kFarUm,
                           "the feed position at which the phantom's z is 0");
  c.rig.initial_face_um = c.first_face_um - number("cover", 100, "um", 0, kFarUm,
                                                   "casting above it, before the first pass");
  c.rig.roughness_um =
      number("roughness", 0.3, "um", 0, 1000, "standard deviation of a pass from its target");
  c.rig.debris.specks =
      static_cast<int>(block.get(IntegerKey{.name = "specks",
                                            .fallback = 40,
                                            .minimum = 0,
                                            .maximum = 10000,
                                            .description = "of debris that a pass leaves"}));
  c.rig.debris.radius_um = number("speck_radius", 60, "um", 0.01, 10000, "of the largest");
  c.rig.debris.hold_ms =
      number("speck_hold", 600, "ms", 0, 60000, "air blast that blows the stickiest away");

  const View& view = c.optics.view;
  c.phantom.seed = c.rig.seed;
  c.phantom.width_um = number("width", view.width * view.pixel_um, "um", 1, kFarUm,
                              "of the specimen with casting; default: the camera's view");
  c.phantom.height_um = number("height", view.height * view.pixel_um, "um", 1, kFarUm,
                               "of the specimen with casting; default: the camera's view");
  c.phantom.depth_um =
      number("depth", 640, "um", 1, kFarUm, "over which the anatomy changes markedly");
  c.phantom.detail_um = number("detail", 3.5 * view.pixel_um, "um", 0.01, kFarUm,
                               "the finest detail; default: 3.5 pixels");
  c.rig.mechanics.face_width_um = c.phantom.width_um;
  c.rig.mechanics.face_height_um = c.phantom.height_um;
}

}  // namespace

Configuration read_configuration(const bridge::CheckedTable& file) {
  Configuration c;
  read_top(file, c);
  read_stage(file.table("stage"), c);
  const CheckedTable rig = file.table("rig");
  c.rig_socket =
      read_endpoint(rig, {.name = "socket", .description = "camera, lines and bench: unix://path"},
                    {bridge::Endpoint::Scheme::unix_socket}, "unix://path")
          .path;
  read_motion(file.table("motion"), c);
  read_wheel(file.table("wheel"), c);
  read_thermal(file.table("thermal"), c);
  read_camera(file.table("camera"), c);
  read_block(file.table("block"), c);
  file.refuse_unknown_keys();
  return c;
}

std::string configuration_reference() {
  const CheckedTable file = CheckedTable::for_reference();
  read_configuration(file);
  std::string text =
      "| key | default | unit | allowed | meaning |\n| --- | --- | --- | --- | --- |\n";
  for (const bridge::DeclaredKey& key : file.declared_keys()) {
    std::string name = key.table;
    name.append(name.empty() ? "" : ".").append(key.name);
    const std::string fallback =
        key.default_value.empty() ? "required" : "`" + key.default_value + "`";
    text.append("| `").append(name).append("` | ").append(fallback).append(" | ");
    text.append(key.unit).append(" | ").append(key.allowed).append(" | ");
    text.append(key.description).append(" |\n");
  }
  return text;
}

}  // namespace biotomy::sim
