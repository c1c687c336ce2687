#include "acquisition/service/rig_check_records.hpp"

#include <cstdlib>
#include <exception>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string>
#include <variant>

#include <fcntl.h>
#include <unistd.h>

#include "acquisition/http/http_server.hpp"
#include "acquisition/http/listen_address.hpp"
#include "acquisition/job/recovery.hpp"
#include "acquisition/records/journal_reader.hpp"
#include "acquisition/records/sample_fit.hpp"
#include "acquisition/records/sample_lock.hpp"
#include "acquisition/records/utc_time.hpp"
#include "acquisition/service/credentials.hpp"
#include "acquisition/service/existing_part.hpp"
#include "acquisition/service/notifications/channels.hpp"

namespace biotomy::acquisition {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSample = "sample";
constexpr const char* kDisk = "disk";
constexpr const char* kNotifications = "notifications";

/// Why nothing can be made in a folder; nothing when it can.
std::optional<std::string> folder_complaint(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    return "the folder " + folder.string() +
           " does not exist: make it, and let it belong to the daemon's user";
  }
  if (::faccessat(AT_FDCWD, folder.c_str(), W_OK | X_OK, AT_EACCESS) == 0) return std::nullopt;
  return "this user may not write into " + folder.string() +
         ": chown it to the daemon's user, or name another";
}

class RecordsCheck {
 public:
  RecordsCheck(const JobSettings& job, const AnsweredRig& rig, const Surroundings& surroundings,
               RigFindings& findings)
      : job_(job), plan_(job.plan), rig_(rig), surroundings_(surroundings), findings_(findings) {}

  void run() {
    if (const auto complaint = folder_complaint(plan_.sample.parent_path())) {
      findings_.wrong(kSample, *complaint);
    }
    try {
      if (reconstruct::SampleFolder::can_begin(plan_.sample)) {
        findings_.good(kSample, plan_.sample.string() + " is new: a job begins with layer 1");
      } else {
        open_sample();
      }
      compare_with_controller();
    } catch (const std::exception& error) {
      findings_.wrong(kSample, error.what());
    }
    check_disk();
    const auto now = surroundings_.wall_clock();
    const Complaints complaints = clock_complaints(now, journal_.last_event_at);
    findings_.wrong("clock", complaints);
    if (complaints.empty()) findings_.good("clock", utc_text(now));
  }

 private:
  void open_sample() {
    const auto sample = reconstruct::SampleFolder::open(plan_.sample);
    if (rig_.camera) {
      if (const auto complaint = sample_complaint(sample, plan_, *rig_.camera)) {
        findings_.wrong(kSample, *complaint);
      }
    }
    if (!fs::exists(sample.journal_path())) {
      findings_.note(kSample, "it has no journal yet: a job begins with layer 1");
      return;
    }
    using Journal = JournalReader::Journal;
    const JournalReader reader(sample.journal_path(), SampleLock::is_held(plan_.sample)
                                                          ? Journal::in_use
                                                          : Journal::at_rest);
    journal_ = reader.summary();
    findings_.good(kSample, plan_.sample.string() + ": " + std::to_string(journal_.last_committed) +
                                " of " + std::to_string(plan_.layers) + " layers are committed");
    if (const auto complaint = committed_files_complaint(sample, reader)) {
      findings_.wrong(kSample, *complaint);
    }
    if (!rig_.camera) return;
    const auto constants = constants_of(job_.camera.settings, *rig_.camera);
    if (const auto complaint = constants_complaint(journal_, constants)) {
      findings_.wrong(kSample, *complaint);
    }
  }

  void compare_with_controller() {
    if (!rig_.controller) {
      findings_.note(kSample, "not compared with the controller, which did not answer");
      return;
    }
    const auto answer = where_to_go_on(plan_, journal_, *rig_.controller, job_.limits);
    if (const auto* disagreement = std::get_if<Disagreement>(&answer)) {
      findings_.wrong(kSample, disagreement->sentence);
      return;
    }
    const auto& next = std::get<Continuation>(answer);
    if (next.layer > plan_.layers) {
      findings_.note(kSample, "all its layers are committed: there is nothing left to do");
    } else {
      findings_.good(kSample, "agrees with the controller; next is layer " +
                                  std::to_string(next.layer) +
                                  (next.ground ? ", which is ground already" : ""));
    }
  }

  void check_disk() {
    if (!rig_.camera) {
      findings_.note(kDisk, "how many layers fit is not known without the camera's size");
      return;
    }
    try {
      const auto room =
          static_cast<std::int64_t>(surroundings_.free_bytes(existing_part(plan_.sample)) /
                                    bytes_of_a_layer(plan_, *rig_.camera));
      const Complaints complaints = disk_complaints(job_, room, journal_.last_committed);
      findings_.wrong(kDisk, complaints);
      if (complaints.empty()) {
        findings_.good(kDisk, "room for " + std::to_string(room) + " more layers, " +
                                  std::to_string(plan_.layers - journal_.last_committed) +
                                  " are to come");
      }
    } catch (const std::exception& error) {
      findings_.wrong(kDisk, error.what());
    }
  }

  const JobSettings& job_;
  const JobPlan& plan_;
  const AnsweredRig& rig_;
  const Surroundings& surroundings_;
  RigFindings& findings_;
  JournalSummary journal_;
};

void check_token(const fs::path& file, RigFindings& findings) {
  constexpr const char* kToken = "token";
  std::error_code error;
  if (!fs::exists(fs::symlink_status(file, error))) {
    if (const auto complaint = folder_complaint(file.parent_path())) {
      findings.wrong(kToken, *complaint);
    } else {
      findings.note(kToken, file.string() + " is made when the daemon starts for the first time");
    }
    return;
  }
  try {
    Credentials::read(file);
    findings.good(kToken, file.string() + " is in order");
  } catch (const SecretFileError& failure) {
    findings.wrong(kToken, failure.what());
  }
}

/// The program as posix_spawnp finds it: by its path, or in PATH.
bool can_be_started(const std::string& program) {
  if (program.find('/') != std::string::npos) return ::access(program.c_str(), X_OK) == 0;
  const char* variable = std::getenv("PATH");
  std::istringstream folders(variable == nullptr ? "" : variable);
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (::access((fs::path(folder) / program).c_str(), X_OK) == 0) return true;
  }
  return false;
}

/// A job needs none to be recorded, but whoever asks for one should not learn it at its end.
void check_calibration_folder(const fs::path& folder, RigFindings& findings) {
  if (const auto complaint = folder_complaint(existing_part(fs::absolute(folder)))) {
    findings.note("calibration", "none can be recorded in " + folder.string() + ": " + *complaint);
  }
}

void check_notifications(const NotifyConfiguration& notify, RigFindings& findings) {
  if (!notify.is_on()) {
    findings.note(kNotifications,
                  "nobody is told when a person is needed: set notify.command or notify.webhook");
    return;
  }
  if (!notify.command.empty() && !can_be_started(notify.command.front())) {
    findings.wrong(kNotifications, "notify.command: there is no program " + notify.command.front() +
                                       " that can be started");
  }
  try {
    for (const auto& channel : make_channels(notify)) {
      findings.good(kNotifications, "by " + channel->name() + "; --test-notification sends one");
    }
  } catch (const SecretFileError& failure) {
    findings.wrong(kNotifications, failure.what());
  }
  if (fs::exists(notify.notifier.queue)) return;
  if (const auto complaint = folder_complaint(existing_part(notify.notifier.queue))) {
    findings.wrong(kNotifications, *complaint);
  }
}

}  // namespace

void check_records(const JobSettings& job, const AnsweredRig& rig, const Surroundings& surroundings,
                   RigFindings& findings) {
  RecordsCheck(job, rig, surroundings, findings).run();
}

void check_address(const ServiceConfiguration& service, RigFindings& findings) {
  constexpr const char* kPage = "page";
  if (const auto complaint = listen_complaint(service.host, service.port)) {
    findings.wrong(kPage, *complaint);
  } else {
    findings.good(kPage, http_url(service.host, service.port));
  }
}

void check_service(const Configuration& configuration, RigFindings& findings) {
  check_token(configuration.service.token_file, findings);
  check_calibration_folder(configuration.job.calibration.folder, findings);
  check_notifications(configuration.notify, findings);
}

}  // namespace biotomy::acquisition
