#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "acquisition/http/message.hpp"
#include "acquisition/records/journal_reader.hpp"
#include "acquisition/viewer/layer_hashes_file.hpp"
#include "acquisition/viewer/live_sample.hpp"

namespace biotomy::acquisition {

inline constexpr std::int64_t kLargestLayer = 999999;

/// Letters of a layer's hash in the address of its image, by which that of another content differs.
inline constexpr std::size_t kDigitsInAddress = 8;

/// What is written down of a sample's layers and of the attempts at them: /layers, /layers/N,
/// /rejected and /history. A sample without a journal has its layers, and no attempts. Every call
/// may throw InvalidRequest, Refusal, SampleError, JournalError. Safe for many threads.
class LayerRecords {
 public:
  /// `live` outlives it.
  LayerRecords(LiveSample& live, JournalReader::Journal journal) : live_(live), journal_(journal) {}

  /// Layers that are never taken again.
  std::int64_t committed() const;

  /// The lower-case hexadecimal SHA-256 of a layer's file; empty where nothing tells it.
  std::string sha256(std::int64_t layer) const;

  ApiResponse list(const ApiRequest& request) const;
  ApiResponse layer(std::int64_t layer) const;
  ApiResponse rejected(const ApiRequest& request) const;
  ApiResponse rejected_picture(const std::string& name, const ApiRequest& request) const;
  ApiResponse history(const ApiRequest& request) const;

 private:
  std::optional<JournalReader> open_journal() const;
  LayerRow layer_on_disk(const reconstruct::SampleFolder& sample, std::int64_t layer) const;

  LiveSample& live_;
  JournalReader::Journal journal_;
  mutable LayerHashesFile hashes_;
};

}  // namespace biotomy::acquisition
