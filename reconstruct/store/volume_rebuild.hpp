#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "reconstruct/interruption.hpp"
#include "reconstruct/sample/sample_folder.hpp"

namespace biotomy::reconstruct {

/// Makes a sample's volume anew from its layer files, with the layout of the volume that is there
/// (or the default, where there is none that can be understood): byte for byte what appending the
/// layers one band after the other makes. It grows in `.volume.ome.zarr.partial` and takes the
/// volume's place when it is complete; until then, and when something goes wrong, the old volume
/// stays. All layers that there are go into it, also those of an incomplete band.
/// What root makes is given to the owner of the sample folder. No other writer may be at work on
/// the sample. `progress(done, total)` is called after each band. Returns the number of layers.
/// Throws SampleError when there is no layer, or one is missing between others or cannot be read,
/// or when the old volume has layers of which there are no files; where its metadata cannot be
/// read, its shards tell.
std::int64_t rebuild_volume(const SampleFolder& sample,
                            const std::function<void(std::int64_t, std::int64_t)>& progress = {},
                            const StopRequested& stop = {});

/// The folders that rebuilds which were killed have left in the sample: a volume that was not
/// finished, and one that was to be replaced. The next rebuild puts them right. One that is at work
/// has such a folder, too.
std::vector<std::filesystem::path> left_by_rebuilds(const SampleFolder& sample);

}  // namespace biotomy::reconstruct
