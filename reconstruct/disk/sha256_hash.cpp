#include "reconstruct/disk/sha256_hash.hpp"

#include <array>

#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {
namespace {

/// OpenSSL says no when it has no memory, or is set up without SHA-256. No layer may be taken for
/// proven by half a hash.
void check(bool done) {
  if (!done) {
    throw SampleError("OpenSSL cannot compute a SHA-256 here: look at its configuration");
  }
}

}  // namespace

Sha256Hash::Sha256Hash() : context_(EVP_MD_CTX_new()) {
  check(context_ != nullptr && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1);
}

void Sha256Hash::add(std::span<const std::byte> bytes) {
  check(EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()) == 1);
}

std::string Sha256Hash::finish() {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int length = 0;
  check(EVP_DigestFinal_ex(context_.get(), digest.data(), &length) == 1);
  constexpr const char* kDigits = "0123456789abcdef";
  std::string hexadecimal;
  for (unsigned int i = 0; i < length; ++i) {
    hexadecimal += kDigits[digest[i] >> 4];
    hexadecimal += kDigits[digest[i] & 15];
  }
  return hexadecimal;
}

}  // namespace biotomy::reconstruct
