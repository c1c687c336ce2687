#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "sim/scenario/scenario.hpp"

namespace biotomy::sim {

/// What is told of a fault, in the order in which it happens.
struct ScheduleEvents {
  std::function<void(const ScenarioEvent&)> began = [](const ScenarioEvent&) {};
  std::function<void(const ScenarioEvent&)> ended = [](const ScenarioEvent&) {};
};

/// A fault that lasts just now.
struct ActiveFault {
  RigFault fault;
  double since_s = 0;  ///< rig time
};

/// Keeps a scenario's time: it is told what the rig does, and knows what is broken. An event that
/// comes up while its fault still lasts changes nothing. The same seed and the same course of the
/// rig give the same faults. One thread at a time.
class Schedule {
 public:
  using RealTime = std::chrono::steady_clock::time_point;

  Schedule(const Scenario& scenario, std::uint64_t seed, ScheduleEvents events);

  /// Rig time never goes back. To be called once before anything else.
  void advance(double rig_s, RealTime now);

  void grind_started(std::uint32_t layer);

  /// `done`: the layer is ground; else the pass was broken off, which is no moment of the layer.
  void grind_ended(std::uint32_t layer, bool done);

  /// Around each photograph. What begins or ends by a photograph begins before it, ends after it.
  void capture_begins();
  void capture_ends();

  /// The camera was asked for something and could not answer.
  void camera_failed();

  /// The controller is about to be given `reset_fault`.
  void reset_given();

  /// Takes up an event beside the scenario's, in place of one of the same name. With the moment "at
  /// rig time 0" it begins at once.
  void add(const ScenarioEvent& event);

  /// Ends the fault if it lasts, and the event for good. False if there is no event of the name.
  bool remove(const std::string& name);

  const std::vector<ActiveFault>& active() const { return active_; }

 private:
  struct Entry {
    ScenarioEvent event;
    double next;                  ///< the moment to wait for; infinite: there is none
    std::vector<double> due_s{};  ///< rig times at which it begins, after its delay
    std::optional<double> since_s{};
    RealTime since{};
    int captures = 0;  ///< since it began
    int grinds = 0;
  };
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  void reached(Occasion::Moment moment, double value);
  bool drawn(const Entry& entry, double value) const;
  void begin(Entry& entry);
  void end(Entry& entry);
  void end_if(bool (*over)(const Entry&));
  void note_active();

  std::uint64_t seed_;
  ScheduleEvents events_;
  std::vector<Entry> entries_;
  std::vector<ActiveFault> active_;
  double rig_s_ = 0;
  RealTime now_{};
  std::uint32_t captures_ = 0;
};

}  // namespace biotomy::sim
