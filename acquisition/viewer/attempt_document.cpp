#include "acquisition/viewer/attempt_document.hpp"

#include "acquisition/quality/metrics_json.hpp"

namespace biotomy::acquisition {

nlohmann::ordered_json attempt_document(const AttemptNote& note) {
  return {{"id", note.id},
          {"layer", note.layer},
          {"attempt", note.attempt},
          {"taken_at", note.taken_at},
          {"verdict", note.verdict},
          {"slug", note.slug},
          {"reason", note.reason},
          {"metrics", metrics_json(note.metrics)},
          {"column_um", note.column.value},
          {"exposure_us", note.exposure_us},
          {"gain", note.gain},
          {"file", note.file}};
}

}  // namespace biotomy::acquisition
