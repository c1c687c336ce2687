#include "reconstruct/picture/huffman_code.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace biotomy::reconstruct {
namespace {

constexpr std::size_t kMostBits = 16;

struct Symbol {
  std::uint64_t count;
  std::size_t number;
};

/// Lengths of an unlimited code for symbols sorted by count, two at least: the two queues of van
/// Leeuwen, in which trees come out in the order of their counts without a heap.
std::vector<std::uint8_t> lengths_of_sorted(const std::vector<Symbol>& symbols) {
  const std::size_t leaves = symbols.size();
  std::vector<std::uint64_t> counts(2 * leaves - 1);
  std::vector<std::size_t> parents(2 * leaves - 1);
  for (std::size_t i = 0; i < leaves; ++i) {
    counts[i] = symbols[i].count;
  }
  std::size_t leaf = 0;
  std::size_t tree = leaves;
  for (std::size_t made = leaves; made < counts.size(); ++made) {
    for (int child = 0; child < 2; ++child) {
      const bool take_leaf = leaf < leaves && (tree == made || counts[leaf] <= counts[tree]);
      const std::size_t taken = take_leaf ? leaf++ : tree++;
      counts[made] += counts[taken];
      parents[taken] = made;
    }
  }
  std::vector<std::uint8_t> depths(counts.size(), 0);
  for (std::size_t node = counts.size() - 1; node-- > 0;) {
    depths[node] = static_cast<std::uint8_t>(depths[parents[node]] + 1);
  }
  depths.resize(leaves);
  return depths;
}

std::uint16_t reversed(std::uint32_t code, int bits) {
  std::uint32_t result = 0;
  for (int bit = 0; bit < bits; ++bit) {
    result = result << 1U | (code >> static_cast<unsigned>(bit) & 1U);
  }
  return static_cast<std::uint16_t>(result);
}

void number_canonically(HuffmanCode& code) {
  std::array<std::uint32_t, kMostBits + 1> of_length{};
  for (const std::uint8_t length : code.lengths) {
    ++of_length[length];
  }
  of_length[0] = 0;
  std::array<std::uint32_t, kMostBits + 1> next{};
  for (std::size_t length = 1; length <= kMostBits; ++length) {
    next[length] = (next[length - 1] + of_length[length - 1]) << 1U;
  }
  for (std::size_t symbol = 0; symbol < code.lengths.size(); ++symbol) {
    const std::uint8_t length = code.lengths[symbol];
    if (length > 0) {
      code.codes[symbol] = reversed(next[length]++, length);
    }
  }
}

}  // namespace

HuffmanCode huffman_code(std::span<const std::uint32_t> counts, int longest) {
  HuffmanCode code{std::vector<std::uint8_t>(counts.size(), 0),
                   std::vector<std::uint16_t>(counts.size(), 0)};
  std::vector<Symbol> symbols;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] > 0) {
      symbols.push_back({counts[i], i});
    }
  }
  std::vector<std::uint8_t> lengths(symbols.size(), 1);
  std::stable_sort(symbols.begin(), symbols.end(),
                   [](const Symbol& a, const Symbol& b) { return a.count < b.count; });
  while (symbols.size() > 1) {
    lengths = lengths_of_sorted(symbols);
    if (lengths.front() <= longest) {  // of the rarest symbol, and no other is longer
      break;
    }
    for (Symbol& symbol : symbols) {  // evener counts make a flatter tree, and keep their order
      symbol.count = symbol.count / 2 + 1;
    }
  }
  for (std::size_t i = 0; i < symbols.size(); ++i) {
    code.lengths[symbols[i].number] = lengths[i];
  }
  number_canonically(code);
  return code;
}

}  // namespace biotomy::reconstruct
