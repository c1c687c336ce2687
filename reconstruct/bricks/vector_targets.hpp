#pragma once

// For which of Highway's targets the kernels are compiled; to be included before anything else of
// Highway. Vectors whose length is known only when the program runs have no blocks to rely on; such
// processors have NEON as well.
#ifndef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#endif
#include <hwy/targets.h>
