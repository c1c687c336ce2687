#include "reconstruct/picture/strip_deflate.hpp"

#include <new>

#include <zlib.h>

namespace biotomy::reconstruct {
namespace {

constexpr int kLevel = 1;
constexpr int kRawWindowBits = -15;  // of 32 KiB; negative: without zlib's header
constexpr int kZlibWindowBits = 15;
constexpr int kMemoryLevel = 9;
constexpr std::size_t kFlushBytes = 16;  // that a flush may take beyond deflateBound

void deflate_with(int window_bits, std::span<const std::uint8_t> plain, bool last,
                  std::vector<std::byte>& out) {
  z_stream state{};
  if (deflateInit2(&state, kLevel, Z_DEFLATED, window_bits, kMemoryLevel, Z_RLE) != Z_OK) {
    throw std::bad_alloc();  // with these parameters nothing else can be wrong
  }
  const std::size_t before = out.size();
  out.resize(before + deflateBound(&state, static_cast<uLong>(plain.size())) + kFlushBytes);
  state.next_in = const_cast<Bytef*>(plain.data());  // zlib's interface knows no const
  state.avail_in = static_cast<uInt>(plain.size());
  state.next_out = reinterpret_cast<Bytef*>(out.data() + before);
  state.avail_out = static_cast<uInt>(out.size() - before);
  deflate(&state, last ? Z_FINISH : Z_SYNC_FLUSH);  // there is room for all of it
  out.resize(before + state.total_out);
  deflateEnd(&state);
}

}  // namespace

void deflate_strip(std::span<const std::uint8_t> plain, bool last, std::vector<std::byte>& out) {
  deflate_with(kRawWindowBits, plain, last, out);
}

std::vector<std::byte> zlib_stream(std::span<const std::uint8_t> plain) {
  std::vector<std::byte> stream;
  deflate_with(kZlibWindowBits, plain, true, stream);
  return stream;
}

}  // namespace biotomy::reconstruct
