#pragma once

#include <cstddef>

#include "acquisition/records/journal_reader.hpp"

namespace biotomy::acquisition {

/// How much of the computer looking at a sample may take, and who may.
struct ViewerSettings {
  std::size_t cache_bytes = 256'000'000;    ///< of decoded chunks, at most
  std::size_t decoded_bytes = 160'000'000;  ///< of decoded layers, at most, or one layer
  int threads = 0;                          ///< that sample one section; 0: half of the processors
  /// Whether somebody may write the sample's journal meanwhile.
  JournalReader::Journal journal = JournalReader::Journal::in_use;
};

}  // namespace biotomy::acquisition
