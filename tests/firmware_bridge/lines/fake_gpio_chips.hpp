#pragma once

#include <algorithm>
#include <cerrno>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <system_error>
#include <vector>

#include "firmware_bridge/lines/gpio_chips.hpp"

namespace biotomy::bridge::testing {

/// GPIO chips that a test wires by hand. As the kernel does, it applies the polarity, notes edges
/// for lines that are held with edges, refuses what is held, and answers ENODEV for the lines of a
/// chip that was unplugged, also after it came back.
class FakeGpioChips {
 public:
  struct Line {
    std::string name;
    bool is_high = false;
    std::string consumer = {};
    bool has_pending_edges = false;
    int request_error = 0;  ///< errno of every request
    int switched_on = 0;    ///< how often, as an output
  };
  struct Chip {
    std::string label;
    std::vector<Line> lines;
    int open_error = 0;  ///< errno of opening it
    int io_error = 0;    ///< errno of every use of a held line
    int plugged_in = 1;  ///< how often; a line of an earlier time is dead
    bool is_there = true;
  };

  std::map<std::string, Chip> chips;  ///< by device file
  int requests = 0;

  void pull(const std::string& device, unsigned int offset, bool high) {
    Line& line = chips.at(device).lines.at(offset);
    if (line.is_high != high && !line.consumer.empty()) line.has_pending_edges = true;
    line.is_high = high;
  }

  void unplug(const std::string& device) { chips.at(device).is_there = false; }
  void plug_in(const std::string& device) {
    Chip& chip = chips.at(device);
    chip.is_there = true;
    ++chip.plugged_in;
    for (Line& line : chip.lines) line.consumer.clear();
  }

  /// What the code under test is given; this object must outlive it.
  std::unique_ptr<GpioChips> make() { return std::make_unique<Access>(*this); }

 private:
  [[noreturn]] static void fail(int error) {
    throw std::system_error(error, std::system_category(), "fake");
  }

  class Held {
   public:
    Held(FakeGpioChips& chips, const GpioRequest& request, bool is_output)
        : chips_(chips), request_(request) {
      ++chips_.requests;
      Chip& chip = chips_.open(request.device);
      Line& line = chip.lines.at(request.offset);
      if (line.request_error != 0) fail(line.request_error);
      if (!line.consumer.empty()) fail(EBUSY);
      line.consumer = kGpioConsumer;
      line.has_pending_edges = false;
      if (request.bias == LineBias::pull_up) line.is_high = true;
      if (is_output) line.is_high = request.active_low;
      plugged_in_ = chip.plugged_in;
    }
    ~Held() {
      Chip& chip = chips_.chips.at(request_.device.string());
      if (chip.plugged_in == plugged_in_) chip.lines.at(request_.offset).consumer.clear();
    }
    Held(const Held&) = delete;
    Held& operator=(const Held&) = delete;

    Line& line() {
      Chip& chip = chips_.chips.at(request_.device.string());
      if (!chip.is_there || chip.plugged_in != plugged_in_) fail(ENODEV);
      if (chip.io_error != 0) fail(chip.io_error);
      return chip.lines.at(request_.offset);
    }
    bool active_low() const { return request_.active_low; }
    bool has_edges() const { return request_.edges; }

   private:
    FakeGpioChips& chips_;
    GpioRequest request_;
    int plugged_in_ = 0;
  };

  class Input final : public GpioInput {
   public:
    Input(FakeGpioChips& chips, const GpioRequest& request) : held_(chips, request, false) {}
    bool take_edges() override {
      return std::exchange(held_.line().has_pending_edges, false) && held_.has_edges();
    }
    bool is_active() override { return held_.line().is_high != held_.active_low(); }

   private:
    Held held_;
  };

  class Output final : public GpioOutput {
   public:
    Output(FakeGpioChips& chips, const GpioRequest& request) : held_(chips, request, true) {}
    void set_active(bool active) override {
      Line& line = held_.line();
      line.is_high = active != held_.active_low();
      if (active) ++line.switched_on;
    }

   private:
    Held held_;
  };

  class Access final : public GpioChips {
   public:
    explicit Access(FakeGpioChips& chips) : chips_(chips) {}

    std::vector<std::filesystem::path> devices() override {
      std::vector<std::filesystem::path> devices;
      for (const auto& [device, chip] : chips_.chips) {
        if (chip.is_there) devices.emplace_back(device);
      }
      return devices;
    }
    GpioChipInfo describe(const std::filesystem::path& device) override {
      const Chip& chip = chips_.open(device);
      GpioChipInfo info{
          .device = device, .name = device.filename(), .label = chip.label, .lines = {}};
      for (const Line& line : chip.lines) {
        info.lines.push_back(
            {.name = line.name, .is_used = !line.consumer.empty(), .consumer = line.consumer});
      }
      return info;
    }
    std::unique_ptr<GpioInput> request_input(const GpioRequest& request) override {
      return std::make_unique<Input>(chips_, request);
    }
    std::unique_ptr<GpioOutput> request_output(const GpioRequest& request) override {
      return std::make_unique<Output>(chips_, request);
    }

   private:
    FakeGpioChips& chips_;
  };

  Chip& open(const std::filesystem::path& device) {
    const auto chip = chips.find(device.string());
    if (chip == chips.end() || !chip->second.is_there) fail(ENOENT);
    if (chip->second.open_error != 0) fail(chip->second.open_error);
    return chip->second;
  }
};

}  // namespace biotomy::bridge::testing
