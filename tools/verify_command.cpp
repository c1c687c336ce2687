#include <chrono>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <set>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "acquisition/records/journal_error.hpp"
#include "acquisition/records/journal_reader.hpp"
#include "acquisition/records/sample_lock.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/sample/layer_verification.hpp"
#include "reconstruct/sample/sample_folder.hpp"
#include "reconstruct/sample/sample_growth.hpp"
#include "reconstruct/store/volume_rebuild.hpp"
#include "reconstruct/store/volume_verification.hpp"
#include "tools/command.hpp"
#include "tools/progress_bar.hpp"

namespace biotomy::tools {
namespace {

namespace fs = std::filesystem;

using reconstruct::Finding;
using reconstruct::LayerHash;
using reconstruct::SampleFolder;
using reconstruct::VerificationListener;

struct Options {
  std::string sample;
  bool deep = false;
};

/// Prints what is found, each once, and counts it.
class Findings {
 public:
  void add(const Finding& finding) {
    const std::string line = finding.file.string() + ": " + finding.what;
    if (told_.insert(line).second) {
      std::cout << line << '\n';
    }
  }
  std::int64_t count() const { return static_cast<std::int64_t>(told_.size()); }

  VerificationListener listener(ProgressBar& bar) {
    return {[this](const Finding& finding) { add(finding); },
            [&bar](std::int64_t done, std::int64_t total) { bar.update(done, total); }};
  }

 private:
  std::set<std::string> told_;
};

/// Whether a daemon, or a rebuild, works on a sample.
class SampleWork {
 public:
  explicit SampleWork(fs::path sample) : sample_(std::move(sample)) { is_seen(); }

  /// Now, or at any time since this was made.
  bool is_seen() { return seen_ = seen_ || acquisition::SampleLock::is_held(sample_); }

  /// Waits for it a moment. False when nobody works any more, or after half a minute of moments: a
  /// band's last shards and its metadata are written in less.
  bool wait() {
    constexpr std::chrono::milliseconds kMoment{200};
    constexpr int kMostMoments = 150;
    if (moments_ == kMostMoments || !acquisition::SampleLock::is_held(sample_)) {
      return false;
    }
    ++moments_;
    std::this_thread::sleep_for(kMoment);
    return true;
  }

 private:
  fs::path sample_;
  bool seen_ = false;
  int moments_ = 0;
};

bool is_there(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

/// From the journal of the job, or what the import wrote down.
std::vector<LayerHash> records_of(const SampleFolder& sample, Findings& findings) {
  std::vector<LayerHash> records;
  try {
    if (is_there(sample.journal_path())) {
      const acquisition::JournalReader journal(sample.journal_path());
      for (const auto& row : journal.committed_layers(1, sample.description().cuboid.size.z)) {
        records.push_back({row.file, row.sha256});
      }
    } else if (is_there(sample.hashes_path())) {
      records = reconstruct::read_layer_hashes(sample.hashes_path());
    }
  } catch (const acquisition::JournalError& error) {
    findings.add({sample.journal_path(), error.what()});
  } catch (const reconstruct::SampleError& error) {
    findings.add({sample.hashes_path(), error.what()});
  }
  return records;
}

/// What is no fault of the sample, but takes room.
void tell_of_leftovers(const SampleFolder& sample) {
  const bool has_volume = is_there(sample.volume_path());
  for (const fs::path& folder : reconstruct::left_by_rebuilds(sample)) {
    std::cout << folder.string() << ": was left by a rebuild that was killed; the next biotomy "
              << (has_volume ? "rebuild removes it" : "rebuild puts it right") << '\n';
  }
}

void run(const Options& options) {
  const SampleFolder sample = SampleFolder::open(options.sample);
  Findings findings;
  SampleWork work(sample.path());
  const reconstruct::SampleGrowth growth{
      .is_seen = [&] { return work.is_seen(); },
      .records = [&] { return records_of(sample, findings); },
      .wait = [&] { return work.wait(); },
  };
  const std::vector<LayerHash> records = records_of(sample, findings);
  std::int64_t layers = 0;
  std::int64_t shards = 0;
  {
    ProgressBar bar("Verifying layers", "files");
    const bool of_a_job = is_there(sample.journal_path());  // which may not be done yet
    layers = reconstruct::verify_layers(sample, records, !of_a_job, findings.listener(bar), growth);
  }
  {
    ProgressBar bar("Verifying the volume", "shards");
    shards = reconstruct::verify_volume(sample, options.deep, findings.listener(bar), growth);
  }
  if (!work.is_seen()) {
    tell_of_leftovers(sample);
  }
  std::cout << "verified" << (options.deep ? " voxel for voxel" : "") << ": layer files " << layers
            << ", shards of the volume " << shards << "; "
            << (findings.count() == 0 ? "nothing is wrong"
                                      : "findings " + std::to_string(findings.count()))
            << std::endl;
  if (findings.count() > 0) {
    throw reconstruct::SampleError(options.sample + ": " + std::to_string(findings.count()) +
                                   (findings.count() == 1 ? " thing is" : " things are") +
                                   " wrong with it, see above");
  }
}

}  // namespace

void add_verify_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "verify", "Checks every layer against its hash and every chunk of the volume.");
  command->add_option("SAMPLE", options->sample, "The sample folder")->required();
  command->add_flag("--deep", options->deep,
                    "Also every voxel of the volume against the layers, and every level against "
                    "the one before");
  command->callback([options] { run(*options); });
}

}  // namespace biotomy::tools
