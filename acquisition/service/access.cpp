#include "acquisition/service/access.hpp"

#include <array>
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <openssl/crypto.h>
#include <openssl/rand.h>
#include <sys/stat.h>
#include <unistd.h>

#include "firmware_bridge/wire/unique_fd.hpp"

namespace biotomy::acquisition {
namespace {

constexpr std::size_t kTokenBytes = 32;
constexpr std::size_t kShortestToken = 16;
constexpr std::size_t kLongestFile = 4096;

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& what) {
  throw AccessError("the token file " + file.string() + " " + what);
}

std::string random_token() {
  std::array<unsigned char, kTokenBytes> bytes{};
  if (RAND_bytes(bytes.data(), static_cast<int>(bytes.size())) != 1) {
    throw AccessError("no random numbers for a token: the system's generator failed");
  }
  constexpr const char* kDigits = "0123456789abcdef";
  std::string token;
  for (const unsigned char byte : bytes) {
    token += kDigits[byte >> 4U];
    token += kDigits[byte & 15U];
  }
  return token;
}

std::string make_token(const std::filesystem::path& file, const bridge::UniqueFd& descriptor) {
  std::string token = random_token();
  const std::string line = token + "\n";
  if (::write(descriptor.get(), line.data(), line.size()) != static_cast<ssize_t>(line.size()) ||
      ::fsync(descriptor.get()) != 0) {
    const std::string reason = std::strerror(errno);
    ::unlink(file.c_str());
    fail(file, "cannot be written: " + reason);
  }
  return token;
}

std::string read_token(const std::filesystem::path& file, const bridge::UniqueFd& descriptor) {
  struct stat information {};
  if (::fstat(descriptor.get(), &information) != 0) {
    fail(file, std::string("cannot be read: ") + std::strerror(errno));
  }
  if ((information.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
    fail(file, "can be read by others: chmod 600 it");
  }
  std::array<char, kLongestFile> text{};
  const ssize_t length = ::read(descriptor.get(), text.data(), text.size());
  if (length < 0) fail(file, std::string("cannot be read: ") + std::strerror(errno));
  std::string token(text.data(), static_cast<std::size_t>(length));
  token.erase(token.find_last_not_of(" \t\r\n") + 1);
  if (token.size() < kShortestToken || token.find_first_of(" \t\r\n") != std::string::npos) {
    fail(file, "must hold one token of at least 16 characters: remove it to have a new one made");
  }
  return token;
}

}  // namespace

std::string read_or_make_token(const std::filesystem::path& file) {
  const bridge::UniqueFd made(
      ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600));
  if (made.valid()) return make_token(file, made);
  if (errno != EEXIST) fail(file, std::string("cannot be made: ") + std::strerror(errno));

  const bridge::UniqueFd found(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  if (!found.valid()) fail(file, std::string("cannot be read: ") + std::strerror(errno));
  return read_token(file, found);
}

Access check_access(std::string_view authorization, std::string_view token) {
  constexpr std::string_view kScheme = "Bearer ";
  if (authorization.substr(0, kScheme.size()) != kScheme) return Access::no_token;
  const std::string_view given = authorization.substr(kScheme.size());
  if (given.size() != token.size()) return Access::wrong_token;
  return CRYPTO_memcmp(given.data(), token.data(), token.size()) == 0 ? Access::granted
                                                                      : Access::wrong_token;
}

}  // namespace biotomy::acquisition
