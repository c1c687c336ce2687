#pragma once

#include <vector>

#include "tests/quality/phantom_sequence.hpp"

namespace biotomy::tests {

/// Thresholds are tuned on one, the report is made of the other.
enum class Seeds { train, test };

/// The sequences of a labelled set, no two of one seed, of kinds that take turns: a specimen that
/// is there all along; one into which the wheel comes after a few layers, and that soon shows
/// bone; one that it leaves again, so that the last layers are nearly empty; thick layers, so that
/// hardly anything is where it was in the layer before; finer detail under a stronger lens; a small
/// specimen that begins and ends within the sequence.
std::vector<SequenceSettings> labelled_set(Seeds seeds, int sequences);

}  // namespace biotomy::tests
