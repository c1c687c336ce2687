#pragma once

#include <filesystem>

namespace biotomy::reconstruct {

/// Gives the folder `fresh` the name `place`, durably, and removes what was there. Both lie in one
/// folder. Whoever opens `place` meanwhile finds the old content or the new: the two names are
/// exchanged in one step (Linux renameat2, RENAME_EXCHANGE). A file system that cannot do that is
/// without the name for the moment between two renames; the old content is `name_aside(fresh)` then
/// and until it is removed.
/// Throws SampleError; then `place` is as it was, unless the message names where the old content
/// lies, `fresh` or `name_aside(fresh)`: then that could not be removed, or not be put back.
void replace_folder(const std::filesystem::path& fresh, const std::filesystem::path& place);

std::filesystem::path name_aside(const std::filesystem::path& fresh);

/// After a replace_folder that was killed: puts the old content back, if it is aside and `place` is
/// not there, and removes it, if `place` is. Throws SampleError.
void settle_replaced_folder(const std::filesystem::path& fresh, const std::filesystem::path& place);

/// Removes a folder with all that is in it, or a file, if it is there. Throws SampleError.
void remove_folder(const std::filesystem::path& folder);

}  // namespace biotomy::reconstruct
