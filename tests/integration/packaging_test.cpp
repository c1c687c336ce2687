// What is installed, and beside the programs: held against Debian's and systemd's own tools, where
// they are.
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/file_content.hpp"
#include "tests/integration/child_process.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

using testing::HasSubstr;

struct Packaging : testing::Test {
  TemporaryFolder folder;

  /// The unit as installed, but with the program that was just built.
  std::filesystem::path unit() const {
    std::string text = content_of(std::filesystem::path(BIOTOMY_PACKAGING) / "biotomyd.service");
    const std::string installed = "/usr/bin/biotomyd";
    const std::size_t at = text.find(installed);
    EXPECT_NE(at, std::string::npos);
    text.replace(at, installed.size(), BIOTOMY_DAEMON);
    const std::filesystem::path file = folder / "biotomyd.service";
    std::ofstream(file) << text;
    return file;
  }
};

bool is_executable(const char* path) {
  return ::access(path, X_OK) == 0;
}

TEST_F(Packaging, HasAUnitThatSystemdUnderstands) {
  if (!is_executable("/usr/bin/systemd-analyze"))
    GTEST_SKIP() << "systemd-analyze is not installed";
  const Outcome outcome =
      run({"/usr/bin/systemd-analyze", "verify", "--man=no", unit()}, folder.path());
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.errors, testing::Not(HasSubstr("biotomyd.service"))) << outcome.errors;
}

TEST_F(Packaging, HasAUnitThatCanDoLittle) {
  if (!is_executable("/usr/bin/systemd-analyze"))
    GTEST_SKIP() << "systemd-analyze is not installed";
  const Outcome outcome = run({"/usr/bin/systemd-analyze", "security", "--no-pager",
                               "--offline=yes", "--threshold=25", unit()},
                              folder.path());
  if (outcome.errors.find("unrecognized option") != std::string::npos) {
    GTEST_SKIP() << "this systemd-analyze cannot look at a file offline";
  }
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output << outcome.errors;  // 2.5 of 10 at most
}

TEST_F(Packaging, MakesTheUserAndTheGroupsThatTheUnitNames) {
  if (!is_executable("/usr/bin/systemd-sysusers")) {
    GTEST_SKIP() << "systemd-sysusers is not installed";
  }
  std::filesystem::create_directories(folder / "etc");
  const Outcome outcome = run({"/usr/bin/systemd-sysusers", "--root=" + folder.path().string(),
                               BIOTOMY_PACKAGING "/biotomy.sysusers"},
                              folder.path());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(content_of(folder / "etc/passwd"), HasSubstr("biotomy:"));
  const std::string groups = content_of(folder / "etc/group");
  EXPECT_THAT(groups, HasSubstr("biotomy:"));
  const std::string unit_text = content_of(unit());
  for (const std::string group : {"gpio", "video", "dialout"}) {
    EXPECT_THAT(groups, testing::ContainsRegex("(^|\n)" + group + ":[^\n]*:biotomy\n"));
    EXPECT_THAT(unit_text, testing::ContainsRegex("SupplementaryGroups=[^\n]*" + group));
  }
}

struct DebianPackages : Packaging {
  void SetUp() override {
    if (!is_executable("/usr/bin/dpkg-shlibdeps")) GTEST_SKIP() << "dpkg-dev is not installed";
    const Outcome outcome =
        run({BIOTOMY_CPACK, "--config", BIOTOMY_BUILD "/CPackConfig.cmake", "-B", folder.path()},
            folder.path());
    ASSERT_EQ(outcome.exit_code, 0) << outcome.output << outcome.errors;
  }

  /// The file of the package of that name, which is the start of the file's.
  std::filesystem::path package(const std::string& name) const {
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
      const std::string file = entry.path().filename();
      if (file.starts_with(name + "_") && file.ends_with(".deb")) return entry.path();
    }
    ADD_FAILURE() << "no package " << name;
    return {};
  }

  std::string told_by_dpkg(const std::string& option, const std::string& name) const {
    const Outcome outcome = run({"/usr/bin/dpkg-deb", option, package(name)}, folder.path());
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
    return outcome.output;
  }
};

TEST_F(DebianPackages, HoldTheProgramsApartFromTheLibraryAndNameWhatBothNeed) {
  const std::string programs = told_by_dpkg("--contents", "biotomy");
  for (const std::string file :
       {"/usr/bin/biotomy\n", "/usr/bin/biotomyd\n", "/usr/bin/biotomy-sim\n",
        "/usr/lib/systemd/system/biotomyd.service\n", "/usr/lib/sysusers.d/biotomy.conf\n",
        "/usr/lib/tmpfiles.d/biotomy.conf\n", "/usr/lib/udev/rules.d/60-biotomy.rules\n",
        "/usr/share/biotomy/register_map.toml\n", "/usr/share/doc/biotomy/docs/operation.md\n"}) {
    EXPECT_THAT(programs, HasSubstr(file));
  }
  EXPECT_THAT(programs, testing::Not(HasSubstr(".hpp")));
  const std::string library = told_by_dpkg("--contents", "libbiotomy-dev");
  EXPECT_THAT(library, HasSubstr("libbiotomy_reconstruct.a\n"));
  EXPECT_THAT(library, HasSubstr("reconstruct/section/section.hpp\n"));
  EXPECT_THAT(library, testing::Not(HasSubstr("/usr/bin")));

  const std::string needed = told_by_dpkg("--field", "biotomy");
  for (const std::string each : {"libmodbus", "libgpiod", "libcamera", "libblosc"}) {
    EXPECT_THAT(needed, testing::ContainsRegex("\nDepends:[^\n]*" + each));
  }
  EXPECT_THAT(told_by_dpkg("--field", "libbiotomy-dev"), HasSubstr("libopencv-dev"));
}

}  // namespace
}  // namespace biotomy::tests
