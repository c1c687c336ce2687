#include <array>
#include <chrono>
#include <cstdio>
#include <ostream>
#include <string>
#include <thread>

#include <gmock/gmock.h>

#include "firmware_bridge/stage/stage.hpp"
#include "firmware_bridge/wire/register_map.hpp"
#include "tests/faults/killed_run.hpp"
#include "tests/faults/killing_point.hpp"
#include "tests/faults/run_journal.hpp"
#include "tests/faults/run_witness.hpp"

namespace biotomy::tests {
namespace {

/// Nothing is said: the point is before the layers or beside them.
constexpr int kAny = -1;

/// A named moment of a run, and what must be true when the daemon is killed there.
struct NamedPoint {
  const char* name;
  std::string steps;      ///< as of killing_point.hpp
  int committed = kAny;   ///< layers, by the journal
  int intended = kAny;    ///< the layer of the last pass that is written down
  std::size_t begun = 0;  ///< passes of the wheel, by the witness
};

void PrintTo(const NamedPoint& point, std::ostream* out) {
  *out << point.name << ": " << point.steps;
}

/// The bytes in hexadecimal of a Modbus request with this command, as a pattern: seven bytes of
/// header, the function (write registers), the first register's address, two bytes of count and one
/// of length, then the registers.
std::string command_bytes(bridge::StageAction action) {
  const auto map = bridge::RegisterMap::read_file(BIOTOMY_REGISTER_MAP);
  std::string bytes(2 * 7, '?');
  const auto add = [&bytes](int value, const char* format) {
    std::array<char, 8> digits{};
    std::snprintf(digits.data(), digits.size(), format, value);
    bytes += digits.data();
  };
  add(0x10, "%02x");
  add(map.at("command").address, "%04x");
  bytes += "??????";
  add(static_cast<int>(action), "%04x");
  return bytes + '*';
}

std::string text_bytes(const std::string& text) {
  std::string bytes;
  for (const char character : text) {
    std::array<char, 4> digits{};
    std::snprintf(digits.data(), digits.size(), "%02x", static_cast<unsigned>(character));
    bytes += digits.data();
  }
  return '*' + bytes + '*';
}

/// Passes of the wheel that the twin has begun: a command that was sent may still be on its way, so
/// it is given time to begin as many as are expected.
std::size_t passes_begun(const SimulatedRig& rig, std::size_t expected) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  for (;;) {
    const std::size_t begun = read_witness(rig.witness()).passes.size();
    if (begun >= expected || std::chrono::steady_clock::now() > deadline) return begun;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

class KillingPoint : public testing::TestWithParam<NamedPoint> {};

TEST_P(KillingPoint, LeavesARunThatGoesOnToItsEnd) {
  const NamedPoint& point = GetParam();
  RigPlan plan{.width = 80, .height = 64, .layers = 5};
  plan.daemon_settings = "[store]\nchunk = [16, 16, 2]\nshard = [64, 64, 2]\n";
  UndisturbedRun undisturbed(plan);
  KilledRun run(plan);
  run.run_daemon_to(point.steps);

  if (point.committed != kAny) {
    const auto journal = read_run_journal(run.rig().sample() / "journal.sqlite");
    EXPECT_EQ(journal.layers.size(), point.committed);
    EXPECT_EQ(journal.grinds.back().layer, point.intended);
    EXPECT_EQ(passes_begun(run.rig(), point.begun), point.begun);
  }

  run.finish();
  EXPECT_THAT(run.verdict(undisturbed.sample()), testing::IsEmpty());
  EXPECT_THAT(run.alarms(), testing::IsEmpty());
}

std::vector<NamedPoint> points_of_a_layer() {
  const std::string wal = "*/journal.sqlite-wal";
  const std::string file = "*/layers/.000002.tif.*";
  const std::string first_stored = "after rename */layers/000001.tif; ";
  const std::string first_committed = first_stored + "after sync " + wal + "; ";
  const std::string grind = command_bytes(bridge::StageAction::grind_pass);
  const std::string ground = first_stored + "after send " + grind + "; ";
  const std::string capture = text_bytes("\"capture\"");
  const std::string stored = "after rename */layers/000002.tif; ";
  return {
      {"BeforeTheIntentIsWritten", first_committed + "before write " + wal, 1, 1, 1},
      {"WhileTheIntentIsWritten", first_committed + "amid write " + wal, 1, 1, 1},
      {"BeforeTheIntentIsSynced", first_committed + "before sync " + wal, 1, 2, 1},
      {"AfterTheIntentIsSynced", first_committed + "after sync " + wal, 1, 2, 1},
      {"BeforeTheGrindIsCommanded", first_stored + "before send " + grind, 1, 2, 1},
      {"AfterTheGrindIsCommanded", first_stored + "after send " + grind, 1, 2, 2},
      {"DuringTheGrind", ground + "before send * 12", 1, 2, 2},
      {"BeforeTheGrindsEndIsWritten", ground + "before write " + wal, 1, 2, 2},
      {"AfterTheGrindsEndIsSynced", ground + "after sync " + wal, 1, 2, 2},
      {"BeforeTheFrameIsAskedFor", ground + "before send " + capture, 1, 2, 2},
      {"AfterTheFrameIsAskedFor", ground + "after send " + capture, 1, 2, 2},
      {"BeforeTheFileIsMade", "before create " + file, 1, 2, 2},
      {"WhileTheFileIsWritten", "amid write " + file, 1, 2, 2},
      {"BeforeTheFileIsSynced", "before sync " + file, 1, 2, 2},
      {"AfterTheFileIsSynced", "after sync " + file, 1, 2, 2},
      {"BeforeTheFileIsReadBack", "before read " + file, 1, 2, 2},
      {"AfterTheFileIsReadBack", "after read " + file, 1, 2, 2},
      {"BeforeTheFileHasItsName", "before rename */layers/000002.tif", 1, 2, 2},
      {"AfterTheFileHasItsName", "after rename */layers/000002.tif", 1, 2, 2},
      {"BeforeTheFolderIsSynced", stored + "before sync */layers", 1, 2, 2},
      {"AfterTheFolderIsSynced", stored + "after sync */layers", 1, 2, 2},
      {"BeforeTheCommitIsWritten", stored + "before write " + wal, 1, 2, 2},
      {"WhileTheCommitIsWritten", stored + "amid write " + wal, 1, 2, 2},
      {"BeforeTheCommitIsSynced", stored + "before sync " + wal, 2, 2, 2},
      {"AfterTheCommitIsSynced", stored + "after sync " + wal, 2, 2, 2},
  };
}

std::vector<NamedPoint> points_of_the_volume() {
  const std::string shard = "*/volume.ome.zarr/0/c/*";
  const std::string coarser_shard = "*/volume.ome.zarr/1/c/*";
  const std::string count = "*/volume.ome.zarr/zarr.json";
  const std::string first_band = "after rename " + count + " 2; ";
  return {
      {"BeforeTheArraysAreThere", "before rename */volume.ome.zarr/0/zarr.json"},
      {"BeforeTheGroupIsThere", "before rename " + count},
      {"BeforeAShardIsMade", "before create " + shard},
      {"WhileAShardIsWritten", "amid write " + shard},
      {"BeforeAShardHasItsName", "before rename " + shard},
      {"AfterAShardHasItsName", "after rename " + shard},
      {"BeforeTheBandIsCounted", "after rename " + count + "; before rename " + count},
      {"AfterTheBandIsCounted", "after rename " + count + " 2"},
      {"WhileACoarserShardIsWrittenAnew", first_band + "amid write " + coarser_shard},
      {"AfterACoarserShardHasItsNameAgain", first_band + "after rename " + coarser_shard},
      {"BeforeTheLastBandIsCounted", first_band + "before rename " + count + " 2"},
      {"AfterTheLastBandIsCounted", first_band + "after rename " + count + " 2"},
  };
}

std::vector<NamedPoint> points_of_the_beginning() {
  const std::string journal = "*/sample/journal.sqlite";
  const std::string fresh_journal = "*/sample/.journal.sqlite.new";
  const std::string wal = journal + "-wal";
  return {
      {"BeforeTheSampleIsDescribed", "before create */sample/.sample.toml.*"},
      {"BeforeTheDescriptionHasItsName", "before rename */sample/sample.toml"},
      {"AfterTheDescriptionHasItsName", "after rename */sample/sample.toml"},
      {"BeforeTheJournalIsMade", "before create " + fresh_journal},
      {"WhileTheJournalIsMade", "amid write " + fresh_journal},
      {"BeforeTheJournalHasItsName", "before rename " + journal},
      {"AfterTheJournalHasItsName", "after rename " + journal},
      {"WhileTheFirstRecordIsWritten", "amid write " + wal},
      {"AfterTheFirstRecordIsSynced", "after sync " + wal},
      {"BeforeItIsHomed", "before send " + command_bytes(bridge::StageAction::home)},
      {"AfterHomingIsCommanded", "after send " + command_bytes(bridge::StageAction::home)},
      {"DuringTheFirstFocusSearch", "after send " + text_bytes("\"capture\"") + " 4"},
  };
}

std::string name_of(const testing::TestParamInfo<NamedPoint>& info) {
  return info.param.name;
}

INSTANTIATE_TEST_SUITE_P(OfALayer, KillingPoint, testing::ValuesIn(points_of_a_layer()), name_of);
INSTANTIATE_TEST_SUITE_P(OfTheVolume, KillingPoint, testing::ValuesIn(points_of_the_volume()),
                         name_of);
INSTANTIATE_TEST_SUITE_P(OfTheBeginning, KillingPoint, testing::ValuesIn(points_of_the_beginning()),
                         name_of);

}  // namespace
}  // namespace biotomy::tests
