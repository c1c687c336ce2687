#include "acquisition/job/early_notes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace biotomy::tests {
namespace {

using namespace acquisition;
using testing::HasSubstr;

JobEventRow note(const std::string& text) {
  return {"operator", "faulted", 0, text, "2026-11-26T20:00:00.000Z"};
}

TEST(EarlyNotes, AreGivenOnceAndInOrder) {
  EarlyNotes notes;
  notes.add(note("first"));
  notes.add(note("second"));
  const std::vector<JobEventRow> rows = notes.take();
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].text, "first");
  EXPECT_EQ(rows[1].at, "2026-11-26T20:00:00.000Z");
  EXPECT_TRUE(notes.take().empty());
}

TEST(EarlyNotes, KeepTheNewestAndTellHowManyWereForgotten) {
  EarlyNotes notes;
  for (int i = 0; i < 1003; ++i) notes.add(note(std::to_string(i)));
  const std::vector<JobEventRow> rows = notes.take();
  ASSERT_EQ(rows.size(), 1001U);
  EXPECT_THAT(rows.front().text, HasSubstr("3 earlier events"));
  EXPECT_EQ(rows[1].text, "3");
  EXPECT_EQ(rows.back().text, "1002");
}

}  // namespace
}  // namespace biotomy::tests
