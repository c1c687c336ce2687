#include "tests/integration/witness_lines.hpp"

#include <fstream>

namespace biotomy::tests {

std::vector<std::string> witness_lines(const std::filesystem::path& log) {
  std::ifstream in(log);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) {
    if (in.eof()) break;  // without its newline
    lines.push_back(line);
  }
  return lines;
}

}  // namespace biotomy::tests
