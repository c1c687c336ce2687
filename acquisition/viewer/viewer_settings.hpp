#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>

#include "acquisition/records/journal_reader.hpp"

namespace biotomy::acquisition {

/// Of a disk on which nothing but exports needs room.
inline constexpr std::uint64_t kLeftFree = std::uint64_t{1} << 30U;

/// How much of the computer looking at a sample may take, and who may.
struct ViewerSettings {
  std::size_t cache_bytes = 256'000'000;    ///< of decoded chunks, at most
  std::size_t decoded_bytes = 160'000'000;  ///< of decoded layers, at most, or one layer
  /// That sample one section. 1: it is sampled by the thread that asks, with that thread's
  /// priority; others that help have the priority of whoever needed them first.
  int threads = 1;
  /// Whether somebody may write the sample's journal meanwhile.
  JournalReader::Journal journal = JournalReader::Journal::in_use;
  std::filesystem::path exports = {};  ///< where they lie; empty: SAMPLE-exports, beside the sample
  /// Bytes of that disk that nobody else needs; if none: all but 1 GiB.
  std::function<std::uint64_t()> bytes_to_spare = {};
};

/// SAMPLE-exports: beside the sample, never in it, so that a sample can be copied without what was
/// made of it.
inline std::filesystem::path default_exports_folder(const std::filesystem::path& sample) {
  return sample.parent_path() / (sample.filename().string() + "-exports");
}

}  // namespace biotomy::acquisition
