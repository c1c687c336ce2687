// docs/architecture.md says in which order the folders of a component stand: each includes only
// what stands further right. So no folder needs, by whatever way, what needs it.
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include <gmock/gmock.h>

namespace biotomy::tests {
namespace {

namespace fs = std::filesystem;

const fs::path kSource = BIOTOMY_SOURCE;

/// Of a component's folders by how far right they stand; those between two arrows stand together.
using Places = std::map<std::string, int>;

Places places_of(const std::string& component) {
  const std::string start = "- `" + component + "`: ";
  std::ifstream page(kSource / "docs" / "architecture.md");
  Places places;
  for (std::string line; std::getline(page, line);) {
    if (!line.starts_with(start)) continue;
    std::istringstream words(line.substr(start.size()));
    int place = 0;
    for (std::string word; words >> word;) {
      if (word == "→") {
        ++place;
      } else {
        places[word.substr(1, word.find('`', 1) - 1)] = place;
      }
    }
  }
  return places;
}

/// The folder of the component that a line includes from; empty where it does not.
std::string included_folder(const std::string& line, const std::string& component) {
  const std::string start = "#include \"" + component + "/";
  if (!line.starts_with(start)) return "";
  const auto end = line.find('/', start.size());
  return end == std::string::npos ? "" : line.substr(start.size(), end - start.size());
}

class FolderOrder : public testing::TestWithParam<std::string> {};

TEST_P(FolderOrder, HasAPlaceForEveryFolder) {
  const Places places = places_of(GetParam());
  for (const auto& entry : fs::directory_iterator(kSource / GetParam())) {
    if (!entry.is_directory() || entry.path().filename() == "scenarios") continue;  // no code
    EXPECT_TRUE(places.contains(entry.path().filename())) << entry.path();
  }
}

TEST_P(FolderOrder, HoldsForEveryInclude) {
  const Places places = places_of(GetParam());
  ASSERT_GT(places.size(), 1U);
  int seen = 0;
  for (const auto& [folder, place] : places) {
    for (const auto& entry : fs::recursive_directory_iterator(kSource / GetParam() / folder)) {
      if (!entry.path().extension().string().ends_with("pp")) continue;
      std::ifstream file(entry.path());
      for (std::string line; std::getline(file, line);) {
        const std::string included = included_folder(line, GetParam());
        if (included.empty() || included == folder) continue;
        ++seen;
        ASSERT_TRUE(places.contains(included)) << entry.path() << ": " << line;
        EXPECT_GT(places.at(included), place) << entry.path() << ": " << line;
      }
    }
  }
  EXPECT_GT(seen, 15);
}

INSTANTIATE_TEST_SUITE_P(Components, FolderOrder,
                         testing::Values("reconstruct", "acquisition", "firmware_bridge", "sim"),
                         [](const auto& name) { return name.param; });

}  // namespace
}  // namespace biotomy::tests
