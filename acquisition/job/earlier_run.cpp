#include "acquisition/job/earlier_run.hpp"

#include <string>

#include "acquisition/job/job_states.hpp"
#include "acquisition/records/journal_reader.hpp"
#include "acquisition/records/layer_journal.hpp"

namespace biotomy::acquisition {
namespace {

/// The states that the journal shows last when a job was at work, or about to go on by itself.
bool is_at_work(const std::string& state) {
  using enum JobState;
  for (const JobState working :
       {preflight, recovering, homing, conditioning, withdrawing, held, finishing}) {
    if (state == to_string(working)) return true;
  }
  return false;
}

}  // namespace

EarlierRun read_earlier_run(const std::filesystem::path& journal) {
  if (!std::filesystem::exists(journal)) return {};
  const LayerJournal brought_up_to_date(journal);  // a reader knows the present version alone
  const JournalReader reader(journal);
  return {.last_sequence = reader.last_sequence(), .was_running = is_at_work(reader.last_state())};
}

}  // namespace biotomy::acquisition
