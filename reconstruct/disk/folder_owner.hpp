#pragma once

#include <filesystem>

namespace biotomy::reconstruct {

/// Throws SampleError, which says who shall run the program, when that is neither root nor the
/// owner of the folder: what another makes in it is closed to the programs of its owner.
void check_acts_for_owner(const std::filesystem::path& folder);

/// Where root acts for another: gives `tree`, a folder, and all that is in it the owner and the
/// group of the folder `model`, durably. Throws SampleError.
void give_to_owner_of(const std::filesystem::path& model, const std::filesystem::path& tree);

}  // namespace biotomy::reconstruct
