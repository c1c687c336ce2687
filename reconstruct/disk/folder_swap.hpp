#pragma once

#include <filesystem>

namespace biotomy::reconstruct {

/// Gives the folder `fresh` the name `place`, durably, and removes what was there. Both lie in one
/// folder. Whoever opens `place` meanwhile finds the old content or the new: the two names are
/// exchanged in one step (Linux renameat2, RENAME_EXCHANGE). A file system that cannot do that is
/// without the name for the moment between two renames.
/// Throws SampleError; then `place` is as it was, unless the message names `fresh`: then `place` is
/// new, and only what was there could not be removed.
void replace_folder(const std::filesystem::path& fresh, const std::filesystem::path& place);

/// Removes a folder with all that is in it, or a file, if it is there. Throws SampleError.
void remove_folder(const std::filesystem::path& folder);

}  // namespace biotomy::reconstruct
