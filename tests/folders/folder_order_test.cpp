// docs/architecture.md says in which order the folders of a component stand: each includes only
// what stands further right. So no folder needs, by whatever way, what needs it.
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
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
  const std::regex word("`([a-z_]+)`|→");
  std::ifstream page(kSource / "docs" / "architecture.md");
  Places places;
  for (std::string line; std::getline(page, line);) {
    if (!line.starts_with(start)) continue;
    int place = 0;
    for (std::sregex_iterator it(line.begin() + static_cast<std::ptrdiff_t>(start.size()),
                                 line.end(), word);
         it != std::sregex_iterator(); ++it) {
      if ((*it)[1].matched) {
        places[(*it)[1]] = place;
      } else {
        ++place;
      }
    }
  }
  return places;
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
  const std::regex include("#include \"" + GetParam() + "/([a-z_]+)/.*");
  int seen = 0;
  for (const auto& [folder, place] : places) {
    for (const auto& entry : fs::recursive_directory_iterator(kSource / GetParam() / folder)) {
      if (!entry.path().extension().string().ends_with("pp")) continue;
      std::ifstream file(entry.path());
      for (std::string line; std::getline(file, line);) {
        std::smatch found;
        if (!std::regex_match(line, found, include) || found[1] == folder) continue;
        ++seen;
        ASSERT_TRUE(places.contains(found[1])) << entry.path() << ": " << line;
        EXPECT_GT(places.at(found[1]), place) << entry.path() << ": " << line;
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
