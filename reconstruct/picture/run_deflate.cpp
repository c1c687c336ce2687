#include "reconstruct/picture/run_deflate.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include <zlib.h>

#include "reconstruct/picture/huffman_code.hpp"

namespace biotomy::reconstruct {
namespace {

static_assert(std::endian::native == std::endian::little, "BitWriter stores words as they are");

// RFC 1951, 3.2.3 to 3.2.7.
constexpr std::size_t kEndOfBlock = 256;
constexpr std::size_t kFirstLength = 257;
constexpr std::size_t kSymbols = 286;
constexpr std::size_t kShortestRun = 4;  // a run of 3 is seldom shorter than its literals
constexpr std::size_t kLongestRun = 258;
constexpr int kLongestCode = 12;  // of 15: four codes fit into one word, for a hair of length
constexpr int kLongestLengthCode = 7;
constexpr unsigned kStoredBlock = 0;
constexpr unsigned kDynamicBlock = 2;

// As much as a stored block holds. The codes' description costs nothing then, tokens stay in the
// cache, and the codes follow the picture.
constexpr std::size_t kBlock = 65535;

struct LengthSymbol {
  std::uint16_t symbol = 0;
  std::uint8_t extra_bits = 0;
  std::uint16_t base = 0;
};

/// How lengths 3 … 258 are written, by length (RFC 1951, 3.2.5).
constexpr std::array<LengthSymbol, kLongestRun + 1> make_length_symbols() {
  std::array<LengthSymbol, kLongestRun + 1> table{};
  std::uint16_t symbol = kFirstLength;
  std::size_t length = 3;
  for (unsigned group = 0; length < kLongestRun; ++group) {
    // Groups of four symbols; a group's symbols cover twice as many lengths each as the group
    // before, from the third group on.
    const auto extra = static_cast<std::uint8_t>(group < 2 ? 0 : group - 1);
    for (int i = 0; i < 4 && length < kLongestRun; ++i, ++symbol) {
      const auto base = static_cast<std::uint16_t>(length);
      for (std::size_t k = 0; k < (std::size_t{1} << extra) && length < kLongestRun; ++k) {
        table[length++] = {symbol, extra, base};
      }
    }
  }
  table[kLongestRun] = {kSymbols - 1, 0, kLongestRun};
  return table;
}

constexpr std::array<LengthSymbol, kLongestRun + 1> kLengthSymbols = make_length_symbols();

/// Bits into bytes, the first into the lowest place. The room is made by the caller.
class BitWriter {
 public:
  explicit BitWriter(std::byte* out) : begin_(out), out_(out) {}

  /// At most 57 bits between two calls of `flush`.
  void put(std::uint64_t bits, unsigned count) {
    bits_ |= bits << count_;
    count_ += count;
  }

  /// Writes eight bytes, of which whole ones count.
  void flush() {
    std::memcpy(out_, &bits_, sizeof bits_);
    out_ += count_ / 8;
    bits_ >>= count_ / 8 * 8;
    count_ %= 8;
  }

  void fill_byte() {
    count_ = (count_ + 7) / 8 * 8;
    flush();
  }

  void copy(std::span<const std::uint8_t> bytes) {
    out_ = std::copy_n(reinterpret_cast<const std::byte*>(bytes.data()), bytes.size(), out_);
  }

  std::size_t size() const { return static_cast<std::size_t>(out_ - begin_); }

 private:
  std::byte* begin_;
  std::byte* out_;
  std::uint64_t bits_ = 0;
  unsigned count_ = 0;
};

/// A block as literals and runs of the byte before.
struct Tokens {
  struct Piece {
    std::uint32_t literals;
    std::uint32_t run;  ///< its length; 0 behind the last literals of the block
  };
  std::vector<Piece> pieces;
  std::array<std::uint32_t, kSymbols> counts{};
  std::uint64_t extra_bits = 0;
};

/// Where the next run worth a match begins, at `place` (which is not 0) or after.
std::size_t next_run(std::span<const std::uint8_t> plain, std::size_t place) {
  for (; place + kShortestRun <= plain.size(); ++place) {
    std::uint32_t here = 0;
    std::uint32_t before = 0;
    std::memcpy(&here, plain.data() + place, sizeof here);
    std::memcpy(&before, plain.data() + place - 1, sizeof before);
    if (here == before) {
      return place;
    }
  }
  return plain.size();
}

std::size_t run_length(std::span<const std::uint8_t> plain, std::size_t place) {
  const std::size_t most = std::min(plain.size() - place, kLongestRun);
  std::size_t length = kShortestRun;
  while (length < most && plain[place + length] == plain[place - 1]) {
    ++length;
  }
  return length;
}

/// In four tables, so that equal neighbours do not wait for each other.
void count_literals(std::span<const std::uint8_t> plain, std::array<std::uint32_t, 1024>& counts) {
  std::size_t i = 0;
  for (; i + 4 <= plain.size(); i += 4) {
    ++counts[plain[i]];
    ++counts[256U + plain[i + 1]];
    ++counts[512U + plain[i + 2]];
    ++counts[768U + plain[i + 3]];
  }
  for (; i < plain.size(); ++i) {
    ++counts[plain[i]];
  }
}

void tokenise(std::span<const std::uint8_t> plain, Tokens& tokens) {
  tokens.pieces.clear();
  tokens.counts.fill(0);
  tokens.extra_bits = 0;
  std::array<std::uint32_t, 1024> literals{};
  std::size_t begin = 0;
  std::size_t place = 1;
  while (begin < plain.size()) {
    place = next_run(plain, place);
    count_literals(plain.subspan(begin, place - begin), literals);
    const std::size_t run = place < plain.size() ? run_length(plain, place) : 0;
    if (run > 0) {
      ++tokens.counts[kLengthSymbols[run].symbol];
      tokens.extra_bits += kLengthSymbols[run].extra_bits + 1U;  // and 1 bit for the distance
    }
    tokens.pieces.push_back(
        {static_cast<std::uint32_t>(place - begin), static_cast<std::uint32_t>(run)});
    place += run;
    begin = place;
  }
  for (std::size_t i = 0; i < literals.size(); ++i) {
    tokens.counts[i % 256] += literals[i];
  }
  tokens.counts[kEndOfBlock] = 1;
}

/// The description of a block's codes (RFC 1951, 3.2.7). Symbols: a length 0 … 15, or 17 and 18
/// for 3 … 10 and 11 … 138 zeros.
struct CodeLengths {
  struct Item {
    std::uint8_t symbol;
    std::uint8_t extra;
  };
  std::vector<Item> items;
  HuffmanCode code;
  std::size_t described = 0;  ///< how many lengths of `code` are written, in kOrder
};

constexpr std::array<std::uint8_t, 19> kOrder{16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                              11, 4,  12, 3, 13, 2, 14, 1, 15};
constexpr std::uint8_t kShortZeros = 17;
constexpr std::uint8_t kLongZeros = 18;
constexpr std::size_t kDistances = 1;

unsigned extra_bits_of(std::uint8_t symbol) {
  return symbol == kLongZeros ? 7 : symbol == kShortZeros ? 3 : 0;
}

CodeLengths describe(const std::vector<std::uint8_t>& literal_lengths, bool has_runs) {
  std::vector<std::uint8_t> lengths = literal_lengths;
  lengths.push_back(has_runs ? 1 : 0);  // the one distance
  CodeLengths description;
  std::array<std::uint32_t, 19> counts{};
  for (std::size_t i = 0; i < lengths.size();) {
    std::size_t zeros = 0;
    while (i + zeros < lengths.size() && lengths[i + zeros] == 0 && zeros < 138) {
      ++zeros;
    }
    CodeLengths::Item item{lengths[i], 0};
    if (zeros >= 11) {
      item = {kLongZeros, static_cast<std::uint8_t>(zeros - 11)};
    } else if (zeros >= 3) {
      item = {kShortZeros, static_cast<std::uint8_t>(zeros - 3)};
    }
    i += zeros >= 3 ? zeros : 1;
    ++counts[item.symbol];
    description.items.push_back(item);
  }
  description.code = huffman_code(counts, kLongestLengthCode);
  description.described = kOrder.size();
  while (description.described > 4 &&
         description.code.lengths[kOrder[description.described - 1]] == 0) {
    --description.described;
  }
  return description;
}

std::uint64_t bits_of(const CodeLengths& description) {
  std::uint64_t bits = 3 + 5 + 5 + 4 + 3 * description.described;
  for (const auto& item : description.items) {
    bits += description.code.lengths[item.symbol] + extra_bits_of(item.symbol);
  }
  return bits;
}

void write_description(const CodeLengths& description, bool last, BitWriter& writer) {
  writer.put(last ? 1 : 0, 1);
  writer.put(kDynamicBlock, 2);
  writer.put(kSymbols - kFirstLength, 5);
  writer.put(kDistances - 1, 5);
  writer.put(description.described - 4, 4);
  writer.flush();
  for (std::size_t i = 0; i < description.described; ++i) {
    writer.put(description.code.lengths[kOrder[i]], 3);
    writer.flush();
  }
  for (const auto& item : description.items) {
    writer.put(description.code.codes[item.symbol], description.code.lengths[item.symbol]);
    writer.put(item.extra, extra_bits_of(item.symbol));
    writer.flush();
  }
}

void write_tokens(std::span<const std::uint8_t> plain, const Tokens& tokens,
                  const HuffmanCode& code, BitWriter& writer) {
  const auto put = [&](std::size_t symbol) {
    writer.put(code.codes[symbol], code.lengths[symbol]);
  };
  for (const auto& [literals, run] : tokens.pieces) {
    std::size_t i = 0;
    for (; i + 4 <= literals; i += 4) {
      put(plain[i]);
      put(plain[i + 1]);
      put(plain[i + 2]);
      put(plain[i + 3]);
      writer.flush();
    }
    for (; i < literals; ++i) {
      put(plain[i]);
    }
    writer.flush();
    if (run > 0) {
      const LengthSymbol& symbol = kLengthSymbols[run];
      put(symbol.symbol);
      writer.put(run - symbol.base, symbol.extra_bits);
      writer.put(0, 1);  // the one distance: 1
      writer.flush();
    }
    plain = plain.subspan(std::size_t{literals} + run);
  }
  put(kEndOfBlock);
  writer.flush();
}

void write_stored(std::span<const std::uint8_t> plain, bool last, BitWriter& writer) {
  writer.put(last ? 1 : 0, 1);
  writer.put(kStoredBlock, 2);
  writer.fill_byte();
  writer.put(plain.size(), 16);
  writer.put(~plain.size() & 0xFFFFU, 16);
  writer.flush();
  writer.copy(plain);
}

std::uint64_t bits_of(const Tokens& tokens, const HuffmanCode& code) {
  std::uint64_t bits = tokens.extra_bits;
  for (std::size_t symbol = 0; symbol < kSymbols; ++symbol) {
    bits += std::uint64_t{tokens.counts[symbol]} * code.lengths[symbol];
  }
  return bits;
}

void write_block(std::span<const std::uint8_t> plain, bool last, Tokens& tokens,
                 BitWriter& writer) {
  tokenise(plain, tokens);
  const HuffmanCode code = huffman_code(tokens.counts, kLongestCode);
  const CodeLengths description = describe(code.lengths, tokens.extra_bits > 0);
  if (bits_of(description) + bits_of(tokens, code) >= 8 * (plain.size() + 5)) {
    write_stored(plain, last, writer);
    return;
  }
  write_description(description, last, writer);
  write_tokens(plain, tokens, code, writer);
}

}  // namespace

void deflate_runs(std::span<const std::uint8_t> plain, bool last, std::vector<std::byte>& out) {
  // A block is never longer than stored, which takes 5 bytes and the rest of the byte before; the
  // writer's last word needs room too.
  const std::size_t blocks = plain.size() / kBlock + 2;
  const std::size_t before = out.size();
  out.resize(before + plain.size() + 16 * blocks + 8);
  BitWriter writer(out.data() + before);
  Tokens tokens;
  while (!plain.empty()) {
    const auto block = plain.first(std::min(kBlock, plain.size()));
    plain = plain.subspan(block.size());
    write_block(block, last && plain.empty(), tokens, writer);
    if (last && plain.empty()) {
      writer.fill_byte();
      out.resize(before + writer.size());
      return;
    }
  }
  write_stored({}, last, writer);  // empty: what zlib calls a sync flush
  out.resize(before + writer.size());
}

std::vector<std::byte> zlib_stream_of_runs(std::span<const std::uint8_t> plain) {
  std::vector<std::byte> stream;
  for (const std::uint8_t byte : kZlibHeader) {
    stream.push_back(static_cast<std::byte>(byte));
  }
  deflate_runs(plain, true, stream);
  const auto sum =
      static_cast<std::uint32_t>(adler32_z(adler32(0, nullptr, 0), plain.data(), plain.size()));
  for (int shift = 24; shift >= 0; shift -= 8) {
    stream.push_back(static_cast<std::byte>(sum >> static_cast<unsigned>(shift) & 0xFFU));
  }
  stream.shrink_to_fit();  // a picture's strips are in memory together
  return stream;
}

}  // namespace biotomy::reconstruct
