#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "acquisition/http/message.hpp"
#include "acquisition/viewer/viewer_settings.hpp"

namespace biotomy::acquisition {

/// What is answered over HTTP of a sample: its layers, its attempts, its sections, its volume, with
/// a rig or without one. It reads files alone, and knows nothing of who may ask. Safe for many
/// threads.
class SampleApi {
 public:
  /// The folder need not be there yet.
  SampleApi(const std::filesystem::path& sample, ViewerSettings settings);
  ~SampleApi();
  SampleApi(const SampleApi&) = delete;
  SampleApi& operator=(const SampleApi&) = delete;

  /// Whether the request's path is one of ours, whatever its method.
  bool answers(const ApiRequest& request) const;

  /// Of a request that is ours.
  static Lane lane(const ApiRequest& request);

  /// Whether it changes something: an access for reading is not enough.
  static bool is_command(const ApiRequest& request);

  /// Never throws: what goes wrong is a response with {"error": {"code", "message"}}.
  ApiResponse answer(const ApiRequest& request) const;

  /// Grows whenever the sample's volume or layers have changed. Looks at a few files' names and
  /// times each time that it is asked.
  std::uint64_t generation() const;

  /// {"committed", "layers_present", "created", "generation"}: the event `sample`.
  std::string sample_event() const;

  /// Is told of every export that changed, as its JSON in one line, from the exports' own thread.
  void on_export(std::function<void(std::string json)> listener);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace biotomy::acquisition
