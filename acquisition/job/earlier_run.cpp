#include "acquisition/job/earlier_run.hpp"

#include <string>

#include "acquisition/job/job_states.hpp"
#include "acquisition/log.hpp"
#include "acquisition/records/journal_error.hpp"
#include "acquisition/records/journal_reader.hpp"
#include "acquisition/records/layer_journal.hpp"
#include "reconstruct/sample/sample_folder.hpp"

namespace biotomy::acquisition {
namespace {

/// The states that the journal shows last when a job was at work, or about to go on by itself. Not
/// `preflight`: what stopped a job there, an alarm or a person, found no journal open to write
/// into.
bool is_at_work(const std::string& state) {
  using enum JobState;
  for (const JobState working : {recovering, homing, conditioning, withdrawing, held, finishing}) {
    if (state == to_string(working)) return true;
  }
  return false;
}

}  // namespace

EarlierRun read_earlier_run(const std::filesystem::path& journal) {
  if (!std::filesystem::exists(journal)) return {};
  const LayerJournal brought_up_to_date(journal);  // a reader knows the present version alone
  const JournalReader reader(journal);
  return {.last_sequence = reader.last_sequence(),
          .was_running = is_at_work(reader.last_state()),
          .alarm = reader.standing_alarm(),
          .committed = reader.committed_count()};
}

EarlierRun take_over_earlier_run(const std::filesystem::path& sample, const std::string& utc) {
  const std::filesystem::path path = sample / reconstruct::SampleFolder::kJournalName;
  EarlierRun earlier;
  try {
    earlier = read_earlier_run(path);
    if (!earlier.was_running) return earlier;
    LayerJournal(path).record_event(
        {.kind = "state",
         .state = to_string(JobState::faulted),
         .layer = 0,
         .text = "the daemon ended while the job ran, and was started again",
         .at = utc});
  } catch (const JournalError& error) {
    log_error("journal", std::string("no job goes on by itself: ") + error.what());
    earlier.was_running = false;
    if (earlier.alarm.empty()) earlier.alarm = error.what();
  }
  return earlier;
}

}  // namespace biotomy::acquisition
