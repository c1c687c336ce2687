#include "reconstruct/store/metadata_text.hpp"

#include <cstddef>
#include <span>

#include "reconstruct/errors.hpp"
#include "reconstruct/store/local_object_reader.hpp"
#include "reconstruct/store/metadata_json.hpp"
#include "reconstruct/store/missing_part.hpp"

namespace biotomy::reconstruct {
namespace {

constexpr int kMostReplacements = 3;  // within one read: a writer is not that quick

}  // namespace

std::optional<std::string> read_metadata_text(ObjectReader& objects, const std::string& name) {
  for (int attempt = 0; attempt < kMostReplacements; ++attempt) {
    const auto version = objects.version(name);
    if (!version) {
      return std::nullopt;
    }
    if (version->size > kMostMetadataBytes) {
      throw SampleError(objects.describe(name) + ": is too large for metadata: it has " +
                        std::to_string(version->size) + " bytes");
    }
    std::string text(version->size, '\0');
    try {
      objects.read(name, *version, 0, std::as_writable_bytes(std::span(text)));
      return text;
    } catch (const ObjectReplaced&) {
      continue;  // a layer was added just now
    }
  }
  throw SampleError(objects.describe(name) + ": keeps changing while it is read");
}

std::string read_metadata_file(const std::filesystem::path& file) {
  LocalObjectReader folder(file.parent_path());
  auto text = read_metadata_text(folder, file.filename().string());
  if (!text) {
    throw SampleError(file.string() + ": " + kIsMissing);
  }
  return *std::move(text);
}

}  // namespace biotomy::reconstruct
