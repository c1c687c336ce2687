#pragma once

#include <atomic>
#include <filesystem>
#include <mutex>
#include <thread>

#include "tests/kernel/gpio_sim_chip.hpp"

namespace biotomy::tests {

/// The wires between a GPIO chip and a rig, while the object lives: the rig's lamp follows its
/// output, the rig's e-stop and door set their inputs. Those are contacts to ground that open when
/// there is danger; then the line is high. A rig that does not answer is danger.
class RigWires {
 public:
  enum Line : unsigned int { estop, door, lamp };

  /// `rig`: its socket.
  RigWires(GpioSimChip& chip, std::filesystem::path rig);

  /// Somebody holds the contacts until the object goes: they do not follow the rig, but pull().
  class Held {
   public:
    explicit Held(RigWires& wires) : wires_(wires), hold_(wires.contacts_) {}
    ~Held() { wires_.is_told_ = false; }
    Held(const Held&) = delete;
    Held& operator=(const Held&) = delete;

    void pull(Line line, bool high) { wires_.chip_.pull(line, high); }

   private:
    RigWires& wires_;
    std::lock_guard<std::mutex> hold_;
  };

 private:
  void carry(const std::stop_token& stop);
  void set_contacts(bool estop_open, bool door_open);

  GpioSimChip& chip_;
  std::filesystem::path rig_;
  std::mutex contacts_;
  bool is_told_ = false;  ///< the contacts are as below
  bool estop_open_ = false;
  bool door_open_ = false;
  std::jthread thread_;
};

}  // namespace biotomy::tests
