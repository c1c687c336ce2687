#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "firmware_bridge/wire/register_map.hpp"

namespace biotomy::bridge {
namespace {

std::string table_of(const RegisterMap& map) {
  std::ostringstream text;
  text << "| register | name | type | scale | unit | access | meaning |\n"
       << "| --- | --- | --- | --- | --- | --- | --- |\n";
  for (const RegisterEntry& entry : map.entries()) {
    text << "| " << to_string(entry.table) << " " << entry.address << " | `" << entry.name << "` | "
         << to_string(entry.type) << " | " << entry.scale << " | " << entry.unit << " | "
         << to_string(entry.access) << " | " << entry.description << " |\n";
  }
  return text.str();
}

TEST(RegisterMapDocument, ShowsTheMapAsItIs) {
  std::ifstream file(BIOTOMY_REGISTER_MAP_DOCUMENT);
  ASSERT_TRUE(file) << "docs/register-map.md is missing";
  std::ostringstream document;
  document << file.rdbuf();
  const std::string table = table_of(RegisterMap::read_file(BIOTOMY_REGISTER_MAP));
  EXPECT_NE(document.str().find(table), std::string::npos)
      << "docs/register-map.md should hold this table:\n"
      << table;
}

}  // namespace
}  // namespace biotomy::bridge
