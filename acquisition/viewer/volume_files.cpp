#include "acquisition/viewer/volume_files.hpp"

#include <algorithm>
#include <string_view>
#include <vector>

#include "acquisition/viewer/file_response.hpp"
#include "acquisition/viewer/refusal.hpp"
#include "acquisition/viewer/request_text.hpp"

namespace biotomy::acquisition {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMetadata = "zarr.json";
constexpr std::size_t kMostDigits = 9;

bool is_number(std::string_view word) {
  return !word.empty() && word.size() <= kMostDigits &&
         word.find_first_not_of("0123456789") == std::string_view::npos;
}

/// Where no link on the way leads out of the volume.
bool lies_in(const fs::path& folder, const fs::path& file) {
  std::error_code error;
  const fs::path real = fs::canonical(file, error);
  if (error) return false;
  const fs::path real_folder = fs::canonical(folder, error);
  if (error) return false;
  return std::mismatch(real_folder.begin(), real_folder.end(), real.begin(), real.end()).first ==
         real_folder.end();
}

}  // namespace

bool is_volume_name(const std::string& name) {
  const std::vector<std::string> words = words_between(name, '/');
  if (words.back() == kMetadata) {
    return words.size() == 1 || (words.size() == 2 && is_number(words[0]));
  }
  return words.size() == 6 && is_number(words[0]) && words[1] == "c" &&
         std::all_of(words.begin() + 2, words.end(), is_number);
}

ApiResponse VolumeFiles::answer(const std::string& name, const ApiRequest& request) const {
  const fs::path file = volume_ / name;
  std::error_code error;
  if (!is_volume_name(name) || !fs::is_regular_file(file, error) || !lies_in(volume_, file)) {
    // A chunk that is not there is an answer to programs that read volumes: all of it is 0.
    throw Refusal(404, "the volume has no file of that name");
  }
  return file_response(request, file,
                       name.ends_with(kMetadata) ? "application/json" : "application/octet-stream");
}

}  // namespace biotomy::acquisition
