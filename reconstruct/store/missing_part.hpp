#pragma once

namespace biotomy::reconstruct {

/// What is said of a part of a volume, metadata or a shard, that must be there and is not.
inline constexpr const char* kIsMissing = "is missing; biotomy rebuild makes the volume anew";

}  // namespace biotomy::reconstruct
