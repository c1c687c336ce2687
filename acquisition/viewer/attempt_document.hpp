#pragma once

#include <nlohmann/json.hpp>

#include "acquisition/records/journal_rows.hpp"

namespace biotomy::acquisition {

/// An attempt as the API and its events give it: {id, layer, attempt, taken_at, verdict, slug,
/// reason, metrics, column_um, exposure_us, gain, file}.
nlohmann::ordered_json attempt_document(const AttemptNote& note);

}  // namespace biotomy::acquisition
