#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>

#include <openssl/evp.h>

namespace biotomy::reconstruct {

/// SHA-256 of bytes that come piece by piece. Every call throws SampleError where OpenSSL fails.
class Sha256Hash {
 public:
  Sha256Hash();
  void add(std::span<const std::byte> bytes);

  /// Lower-case hexadecimal; ends the hash.
  std::string finish();

 private:
  struct Free {
    void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
  };
  std::unique_ptr<EVP_MD_CTX, Free> context_;
};

}  // namespace biotomy::reconstruct
