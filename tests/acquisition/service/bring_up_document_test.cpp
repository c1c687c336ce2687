#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/file_content.hpp"

namespace biotomy::tests {
namespace {

namespace fs = std::filesystem;

/// All sources, their string literals as the compiler joins them.
std::string sources() {
  std::string text;
  for (const char* folder : {"acquisition", "firmware_bridge", "reconstruct", "tools"}) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(BIOTOMY_SOURCES) / folder)) {
      const std::string extension = entry.path().extension();
      if (extension == ".cpp" || extension == ".hpp") text += content_of(entry.path());
    }
  }
  std::string joined;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t next = text.find_first_not_of(" \n", at + 1);
    const bool ends_a_literal = text[at] == '"' && next != std::string::npos && text[next] == '"' &&
                                text.find('\n', at) < next;
    if (text.compare(at, 2, "\\\"") == 0) {
      joined += '"';
      at += 2;
    } else if (ends_a_literal) {
      at = next + 1;
    } else {
      joined += text[at++];
    }
  }
  return joined;
}

/// The sentences in the first column of the page's last table.
std::vector<std::string> sentences() {
  std::istringstream page(content_of(BIOTOMY_BRING_UP_PAGE));
  std::vector<std::string> found;
  bool is_in_table = false;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("| what you see |")) is_in_table = true;
    if (is_in_table && line.starts_with("| `")) {
      found.push_back(line.substr(3, line.find("` |") - 3));
    }
  }
  return found;
}

/// What stands between the places that change.
std::vector<std::string> fixed_parts(const std::string& sentence) {
  const std::string gap = "…";
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= sentence.size();) {
    const std::size_t end = std::min(sentence.find(gap, begin), sentence.size());
    std::string part = sentence.substr(begin, end - begin);
    part.erase(0, part.find_first_not_of(' '));
    part.erase(part.find_last_not_of(' ') + 1);
    if (!part.empty()) parts.push_back(part);
    begin = end + gap.size();
  }
  return parts;
}

TEST(BringUpDocument, HasTheProgramsOwnSentences) {
  constexpr std::size_t kLeastSentences = 30;
  constexpr std::size_t kLeastLength = 8;  // what is shorter is found anywhere
  const std::string all = sources();
  const std::vector<std::string> page = sentences();
  EXPECT_GE(page.size(), kLeastSentences) << "the table was not found in " BIOTOMY_BRING_UP_PAGE;
  for (const std::string& sentence : page) {
    for (const std::string& part : fixed_parts(sentence)) {
      EXPECT_GE(part.size(), kLeastLength) << sentence;
      EXPECT_NE(all.find(part), std::string::npos)
          << "no source says \"" << part << "\" of the page's \"" << sentence << "\"";
    }
  }
}

}  // namespace
}  // namespace biotomy::tests
