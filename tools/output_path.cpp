#include "tools/output_path.hpp"

#include <system_error>

#include "reconstruct/absolute_folder.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/sample/sample_folder.hpp"

namespace biotomy::tools {
namespace {

namespace fs = std::filesystem;

/// Without links and dots. What is not there yet has neither.
fs::path real_path(const fs::path& path) {
  std::error_code error;
  const fs::path absolute = fs::absolute(path, error);
  fs::path real = fs::weakly_canonical(absolute, error);
  return error ? absolute.lexically_normal() : real;
}

/// The sample's folder that `path` is or lies in; empty when there is none.
fs::path sample_around(const fs::path& path) {
  for (fs::path folder = path;; folder = folder.parent_path()) {
    std::error_code error;
    if (fs::exists(folder / reconstruct::SampleFolder::kDescriptionName, error)) return folder;
    if (folder == folder.parent_path()) return {};
  }
}

}  // namespace

void refuse_output_in_sample(const std::string& option, const fs::path& output) {
  // A file that takes the place of a link is written where the link lies, a folder where it leads.
  fs::path sample = sample_around(real_path(output));
  if (sample.empty()) {
    sample = sample_around(real_path(reconstruct::absolute_folder(output).parent_path()));
  }
  if (sample.empty()) return;
  throw reconstruct::InvalidRequest(option + " " + output.string() + ": lies in the sample " +
                                    sample.string() +
                                    ", whose files are not for results: name a place outside it");
}

}  // namespace biotomy::tools
