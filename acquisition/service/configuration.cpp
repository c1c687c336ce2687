#include "acquisition/service/configuration.hpp"

#include <algorithm>
#include <utility>

#include "acquisition/number_text.hpp"
#include "acquisition/rig/stage_checks.hpp"
#include "acquisition/service/configuration_keys.hpp"
#include "acquisition/service/focus_section.hpp"
#include "acquisition/service/quality_section.hpp"
#include "acquisition/service/safety_section.hpp"
#include "acquisition/service/store_section.hpp"
#include "firmware_bridge/camera/capture_time_out.hpp"
#include "firmware_bridge/wire/checked_table.hpp"
#include "firmware_bridge/wire/endpoint.hpp"
#include "reconstruct/errors.hpp"

namespace biotomy::acquisition {
namespace {

using bridge::CheckedTable;
using bridge::FlagKey;
using bridge::IntegerKey;
using bridge::TextKey;
using std::chrono::milliseconds;

bridge::Endpoint parse_endpoint_of(const CheckedTable& table, const std::string& text) {
  try {
    return bridge::parse_endpoint(text);
  } catch (const bridge::ConfigurationError& error) {
    table.reject("endpoint", error.what());
  }
}

/// The controller's address; the path of a serial line relative to the file's folder.
std::string read_stage_endpoint(const CheckedTable& table) {
  const std::string text = table.get(
      TextKey{.name = "endpoint",
              .description = "the controller: \"tcp://host:port\", or \"rtu:///dev/name\" for a "
                             "serial line"});
  bridge::Endpoint endpoint = parse_endpoint_of(table, text);
  if (endpoint.scheme == bridge::Endpoint::Scheme::unix_socket) {
    table.reject("endpoint", "\"" + text +
                                 "\" is not possible; expected \"tcp://host:port\" or "
                                 "\"rtu:///dev/name\"");
  }
  if (!endpoint.path.empty()) endpoint.path = table.resolve(endpoint.path);
  return bridge::to_string(endpoint);
}

StageConfiguration read_stage(const CheckedTable& table) {
  StageConfiguration stage;
  stage.endpoint = read_stage_endpoint(table);
  stage.serial = bridge::read_serial_format(table);
  stage.register_map = table.resolve(table.get(TextKey{
      .name = "register_map",
      .fallback = "register_map.toml",
      .description = "the file that says where the controller keeps what; see register-map.md"}));
  stage.response_timeout =
      duration(table, "response_timeout_ms", stage.response_timeout,
               "a controller that has not answered after so long did not answer", 10, 10000);
  return stage;
}

bridge::GpioLineSettings read_line(const CheckedTable& table, bool required) {
  using enum bridge::LineBias;
  bridge::GpioLineSettings line;
  line.chip = optional_text(
      table, "chip", "the GPIO chip: \"gpiochip0\", its label, or a path as \"/dev/gpiochip0\"");
  line.line = optional_text(table, "line", "the line's name, or its offset as a text");
  line.active_low = table.get(FlagKey{.name = "active_low",
                                      .fallback = line.active_low,
                                      .description = "a low voltage means on (pressed, open)"});
  const std::string bias =
      table.get(TextKey{.name = "bias",
                        .fallback = "as-is",
                        .choices = {"as-is", "disabled", "pull-up", "pull-down"},
                        .description = "the line's resistor"});
  line.bias = bias == "pull-up"     ? pull_up
              : bias == "pull-down" ? pull_down
              : bias == "disabled"  ? disabled
                                    : as_is;
  if (required && line.chip.empty()) table.reject("chip", "missing; the gpiod backend needs it");
  if (required && line.line.empty()) table.reject("line", "missing; the gpiod backend needs it");
  return line;
}

bridge::GpioLineSettings read_input_line(const CheckedTable& table, bool required) {
  bridge::GpioLineSettings line = read_line(table, required);
  line.edges = table.get(FlagKey{.name = "edges",
                                 .fallback = line.edges,
                                 .description = "see pulses between two ticks, too; without it, "
                                                "as for a chip that has no interrupts, a pulse "
                                                "shorter than a tick is lost"});
  return line;
}

std::optional<bridge::GpioLineSettings> read_optional_line(const CheckedTable& table) {
  bridge::GpioLineSettings line = read_line(table, table.has("chip") || table.has("line"));
  return line.chip.empty() ? std::nullopt : std::optional(line);
}

/// The socket's path of a "unix://" endpoint, which the socket backend needs.
std::string read_socket_endpoint(const CheckedTable& table, bool required) {
  std::string text = optional_text(table, "endpoint",
                                   "of the socket backend: \"unix://path\" of the rig's socket");
  if (text.empty()) {
    if (required) table.reject("endpoint", "missing; the socket backend needs \"unix://path\"");
    return text;
  }
  const bridge::Endpoint endpoint = parse_endpoint_of(table, text);
  if (endpoint.scheme != bridge::Endpoint::Scheme::unix_socket) {
    table.reject("endpoint", "\"" + text + "\" is not possible; expected \"unix://path\"");
  }
  return table.resolve(endpoint.path).string();
}

LinesConfiguration read_lines(const CheckedTable& table) {
  LinesConfiguration lines;
  const bool gpiod =
      table.get(TextKey{.name = "backend",
                        .fallback = "socket",
                        .choices = {"socket", "gpiod"},
                        .description = "where e-stop, door and lamp are wired: to another "
                                       "process or to GPIO lines of this computer"}) == "gpiod";
  lines.backend = gpiod ? LinesConfiguration::Backend::gpiod : LinesConfiguration::Backend::socket;
  lines.endpoint = read_socket_endpoint(table, !gpiod);
  lines.response_timeout = duration(table, "response_timeout_ms", lines.response_timeout,
                                    "of the socket backend", 10, 10000);
  lines.gpiod.debounce =
      duration(table, "debounce_ms", lines.gpiod.debounce,
               "of the gpiod backend: how long e-stop and door must have been safe, without an "
               "edge, before they count as safe; danger counts at once, however short",
               0, 100);
  lines.gpiod.estop = read_input_line(table.table("estop"), gpiod);
  lines.gpiod.door = read_input_line(table.table("door"), gpiod);
  lines.gpiod.lamp = read_line(table.table("lamp"), gpiod);
  lines.gpiod.trigger = read_optional_line(table.table("trigger"));
  lines.gpiod.tower_light = read_optional_line(table.table("tower_light"));
  return lines;
}

/// How lines.trigger goes with the camera's exposures; the line itself is read with the lines.
bridge::CameraSyncSettings read_camera_sync(const CheckedTable& table, bool libcamera) {
  using Mode = bridge::CameraSyncSettings::Mode;
  bridge::CameraSyncSettings sync;
  const std::string mode =
      table.get(TextKey{.name = "sync",
                        .fallback = "none",
                        .choices = {"none", "trigger", "strobe"},
                        .description = "of the libcamera backend: what lines.trigger does for a "
                                       "frame: a pulse makes the camera expose (the camera must be "
                                       "set to wait for it), or a lamp is on for it alone"});
  sync.mode = mode == "trigger" ? Mode::trigger : mode == "strobe" ? Mode::strobe : Mode::none;
  sync.pulse = std::chrono::microseconds(
      table.get(IntegerKey{.name = "trigger_pulse_us",
                           .fallback = sync.pulse.count(),
                           .unit = "µs",
                           .minimum = 1,
                           .maximum = 1000000,
                           .description = "how long a trigger is active"}));
  if (sync.mode != Mode::none && !libcamera) {
    table.reject("sync", "\"" + mode + "\" is not possible; it is of the libcamera backend");
  }
  return sync;
}

CameraConfiguration read_camera(const CheckedTable& table, CameraPlan& plan) {
  CameraConfiguration camera;
  const bool libcamera =
      table.get(TextKey{.name = "backend",
                        .fallback = "socket",
                        .choices = {"socket", "libcamera"},
                        .description = "a camera of another process, or one that libcamera "
                                       "knows"}) == "libcamera";
  camera.backend =
      libcamera ? CameraConfiguration::Backend::libcamera : CameraConfiguration::Backend::socket;
  camera.endpoint = read_socket_endpoint(table, !libcamera);
  camera.response_timeout =
      duration(table, "response_timeout_ms", camera.response_timeout,
               "of the socket backend, for everything but a frame", 10, 60000);
  camera.libcamera.camera = optional_text(
      table, "camera", "of the libcamera backend: id or model; empty is the first there is");
  camera.libcamera.width = count(table, "width", 0, 0, 65535,
                                 "of the libcamera backend: pixels; 0 is the largest offered");
  camera.libcamera.height = count(table, "height", 0, 0, 65535, "likewise");
  camera.libcamera.pixel_format = optional_text(
      table, "pixel_format",
      "of the libcamera backend: \"BGR888\", \"NV12\", \"SRGGB12_CSI2P\" …; empty is the best "
      "offered, finished colours before raw values");
  camera.libcamera.raw_is_srgb =
      table.get(TextKey{.name = "raw_transfer",
                        .fallback = "srgb",
                        .choices = {"srgb", "linear"},
                        .description = "of a raw pixel_format, which gives 16 bits: the curve that "
                                       "viewers expect, or values in proportion to the light"}) ==
      "srgb";
  camera.libcamera.viewfinder_width =
      count(table, "viewfinder_width", 0, 0, 4096,
            "of the libcamera backend: pixels of a small picture beside each frame, where the "
            "camera can; 0 is none");
  camera.libcamera.sync = read_camera_sync(table, libcamera);

  plan.settings.exposure = std::chrono::microseconds(
      table.get(IntegerKey{.name = "exposure_us",
                           .fallback = plan.settings.exposure.count(),
                           .unit = "µs",
                           .minimum = 1,
                           .maximum = 60000000,
                           .description = "how long a frame is exposed"}));
  plan.settings.gain = number(table, "gain", plan.settings.gain, "", 0.01, 1000.0, "of the sensor");
  plan.settings.red_gain = number(table, "red_gain", plan.settings.red_gain, "", 0.01, 100.0,
                                  "white balance; green is 1");
  plan.settings.blue_gain =
      number(table, "blue_gain", plan.settings.blue_gain, "", 0.01, 100.0, "likewise");
  plan.capture_time_out = duration(table, "capture_timeout_ms", plan.capture_time_out,
                                   "a camera without a frame after so long does not answer; at "
                                   "least twelve times exposure_us");
  const milliseconds least = bridge::least_time_out(plan.settings.exposure);
  if (plan.capture_time_out < least) {
    table.reject("capture_timeout_ms", std::to_string(plan.capture_time_out.count()) +
                                           " is too short for camera.exposure_us, which is " +
                                           std::to_string(plan.settings.exposure.count()) +
                                           "; expected at least " + std::to_string(least.count()) +
                                           ", twelve exposures");
  }
  return camera;
}

JobPlan read_job(const CheckedTable& table) {
  JobPlan job;
  job.sample = table.resolve(table.get(
      TextKey{.name = "sample",
              .description =
                  "the sample folder; made when the job starts, gone on with when it is there"}));
  if (!job.sample.has_filename()) job.sample = job.sample.parent_path();
  job.name = optional_text(table, "name", "of the sample; empty is the folder's name");
  if (job.name.empty()) job.name = job.sample.filename().string();
  job.notes = optional_text(table, "notes", "whatever should be known of the sample");
  job.layers = table.get(IntegerKey{.name = "layers",
                                    .minimum = 1,
                                    .maximum = 999999,
                                    .description = "how many layers are ground"});
  job.layer_thickness = length(table, "layer_thickness_um", std::nullopt, "of each layer");
  const std::vector<double> pixel =
      table.get(bridge::NumbersKey{.name = "pixel_um",
                                   .unit = "µm",
                                   .minimum = 0.001,
                                   .maximum = kMetre,
                                   .count = 2,
                                   .description = "size of a camera pixel on the face, [x, y]"});
  job.pixel_x = {pixel[0]};
  job.pixel_y = {pixel[1]};
  job.first_face =
      position(table, "first_face_um", std::nullopt, "feed position to which layer 1 is ground");
  const std::int64_t bits =
      table.get(IntegerKey{.name = "bits",
                           .fallback = job.bits,
                           .minimum = 8,
                           .maximum = 16,
                           .description = "of one colour in a frame: 8 or 16"});
  if (bits != 8 && bits != 16) table.reject("bits", "expected 8 or 16");
  job.bits = static_cast<int>(bits);
  job.spindle_rpm =
      number(table, "spindle_rpm", job.spindle_rpm, "rpm", 1.0, 60000.0, "speed of the wheel");
  job.clear_duration =
      duration(table, "clear_ms", job.clear_duration, "air blast over the fresh face", 1, 65535);
  job.settle_duration = duration(table, "settle_ms", job.settle_duration,
                                 "waited for vibrations to settle", 0, 3600000);
  job.lamp_warm_up = duration(table, "lamp_warm_up_ms", job.lamp_warm_up,
                              "waited after the lamp is switched on", 0, 3600000);
  const std::string after_restart = table.get(TextKey{
      .name = "after_restart",
      .fallback = "wait",
      .choices = {"wait", "go-on"},
      .description = "a daemon that starts and finds that the job was running when the last one "
                     "ended (a crash, a power cut) waits for an operator, or goes on by itself if "
                     "journal and controller agree"});
  job.after_restart =
      after_restart == "go-on" ? JobPlan::AfterRestart::go_on : JobPlan::AfterRestart::wait;
  return job;
}

CalibrationPlan read_calibration(const CheckedTable& table) {
  CalibrationPlan calibration;
  calibration.folder = table.resolve(
      table.get(TextKey{.name = "folder",
                        .fallback = calibration.folder.string(),
                        .description = "where biotomy calibrate puts what it records"}));
  calibration.flat = table.get(
      FlagKey{.name = "flat",
              .fallback = calibration.flat,
              .description =
                  "frames are corrected by the flat field in it: pixel by pixel the same light"});
  calibration.dark = table.get(
      FlagKey{.name = "dark",
              .fallback = calibration.dark,
              .description = "frames are corrected by the dark field in it: what the sensor shows "
                             "without light"});
  calibration.frames =
      count(table, "frames", calibration.frames, 1, 1000, "whose mean a calibration is");
  return calibration;
}

/// A camera that is triggered switches the line itself: only it knows when.
void give_trigger_to_camera(const CheckedTable& camera, Configuration& configuration) {
  bridge::CameraSyncSettings& sync = configuration.camera.libcamera.sync;
  if (sync.mode == bridge::CameraSyncSettings::Mode::none) return;
  std::optional<bridge::GpioLineSettings>& trigger = configuration.lines.gpiod.trigger;
  if (!trigger) camera.reject("sync", "needs a line: name its chip and line in [lines.trigger]");
  sync.line = *std::exchange(trigger, std::nullopt);
}

/// A wheel that grinds must not come near to one that stands, however slowly it is to grind.
void check_wheel_speeds(const CheckedTable& safety, const JobSettings& job) {
  constexpr double kOfSpindleSpeed = 1.0 / 3.0;
  const double most = kOfSpindleSpeed * job.plan.spindle_rpm;
  const double turning = turning_rpm(job.limits);
  if (turning <= most) return;
  safety.reject("wheel_stands_rpm",
                "where it must stand, a wheel would count as turning only above " +
                    number_text(turning) +
                    " rpm, three times as much, and that must be at most a third of "
                    "job.spindle_rpm, which is " +
                    number_text(job.plan.spindle_rpm));
}

Configuration read(const CheckedTable& document) {
  Configuration configuration;
  configuration.job.plan = read_job(document.table("job"));
  configuration.stage = read_stage(document.table("stage"));
  configuration.lines = read_lines(document.table("lines"));
  configuration.camera = read_camera(document.table("camera"), configuration.job.camera);
  give_trigger_to_camera(document.table("camera"), configuration);
  configuration.job.calibration = read_calibration(document.table("calibration"));
  configuration.job.focus =
      read_focus(document.table("focus"),
                 std::max(configuration.job.plan.pixel_x, configuration.job.plan.pixel_y));
  read_quality(document.table("quality"), configuration.job.thresholds, configuration.job.ladder);
  configuration.job.store = read_store(document.table("store"));
  configuration.job.limits = read_safety(document.table("safety"));
  check_wheel_speeds(document.table("safety"), configuration.job);
  configuration.service = read_service(document.table("service"));
  configuration.notify = read_notify(document.table("notify"));
  return configuration;
}

}  // namespace

Configuration read_configuration(const std::filesystem::path& file) {
  const CheckedTable document = CheckedTable::read_file(std::filesystem::absolute(file));
  Configuration configuration = read(document);
  document.refuse_unknown_keys();
  return configuration;
}

Configuration parse_configuration(const std::string& text, const std::string& source) {
  const CheckedTable document = CheckedTable::parse(text, source);
  Configuration configuration = read(document);
  document.refuse_unknown_keys();
  return configuration;
}

const char* smallest_configuration() {
  return R"toml([job]
sample = "knee-042"
layers = 1000
layer_thickness_um = 20.0
pixel_um = [10.0, 10.0]
first_face_um = 1000.0

[stage]
endpoint = "tcp://127.0.0.1:1502"

[lines]
endpoint = "unix://rig.sock"

[camera]
endpoint = "unix://rig.sock"

[focus]
start_um = 0.0
)toml";
}

std::vector<bridge::DeclaredKey> known_keys() {
  const CheckedTable document = CheckedTable::parse(smallest_configuration(), "rig.toml");
  read(document);
  return document.declared_keys();
}

}  // namespace biotomy::acquisition
