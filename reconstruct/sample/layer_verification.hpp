#pragma once

#include <vector>

#include "reconstruct/sample/finding.hpp"
#include "reconstruct/sample/layer_hashes.hpp"
#include "reconstruct/sample/sample_folder.hpp"
#include "reconstruct/sample/sample_growth.hpp"

namespace biotomy::reconstruct {

/// Compares every layer file with its record: files that are missing or changed, files without a
/// record, layers that are missing between others. Files are hashed in parallel. Without any
/// records, files are only decoded, and that is a finding too. A layer that was named after
/// `records` were read is looked up in those of now; the newest is named before it is recorded, and
/// is no finding while the sample grows.
/// `all_expected`: the sample is complete, so that a layer missing at its deep end is a finding.
/// Progress is in files. Returns the number of files.
std::int64_t verify_layers(const SampleFolder& sample, const std::vector<LayerHash>& records,
                           bool all_expected, const VerificationListener& listener,
                           const SampleGrowth& growth = {});

}  // namespace biotomy::reconstruct
