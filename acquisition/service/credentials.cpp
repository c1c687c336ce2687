#include "acquisition/service/credentials.hpp"

#include <algorithm>
#include <cctype>
#include <sstream>
#include <utility>

#include <openssl/crypto.h>
#include <openssl/rand.h>
#include <openssl/sha.h>

namespace biotomy::acquisition {
namespace {

constexpr std::size_t kTokenBytes = 32;
constexpr std::size_t kShortestToken = 16;
constexpr std::size_t kLongestName = 64;
constexpr const char* kWhat = "the token file";
constexpr const char* kNameOfOneToken = "operator";

[[noreturn]] void fail(const std::string& file, const std::string& problem) {
  throw SecretFileError(std::string(kWhat) + " " + file + " " + problem);
}

std::string random_token() {
  std::array<unsigned char, kTokenBytes> bytes{};
  if (RAND_bytes(bytes.data(), static_cast<int>(bytes.size())) != 1) {
    throw SecretFileError("no random numbers for a token: the system's generator failed");
  }
  constexpr const char* kDigits = "0123456789abcdef";
  std::string token;
  for (const unsigned char byte : bytes) {
    token += kDigits[byte >> 4U];
    token += kDigits[byte & 15U];
  }
  return token;
}

bool is_name(const std::string& text) {
  return text.size() <= kLongestName && std::all_of(text.begin(), text.end(), [](unsigned char c) {
           return std::isalnum(c) != 0 || c == '.' || c == '_' || c == '-';
         });
}

}  // namespace

Credentials Credentials::read_or_make(const std::filesystem::path& file) {
  make_secret_file(file, kWhat, random_token() + "\n");
  return read(file);
}

Credentials Credentials::read(const std::filesystem::path& file) {
  return parse(read_secret_file(file, kWhat), file.string());
}

Credentials Credentials::parse(const std::string& text, const std::string& file) {
  Credentials read;
  std::istringstream lines(text);
  int number = 0;
  bool has_nameless = false;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::istringstream words(line);
    std::string name;
    std::string token;
    std::string more;
    if (!(words >> name) || name.front() == '#') continue;
    const bool nameless = !(words >> token);
    if (nameless) token = std::exchange(name, kNameOfOneToken);
    has_nameless = has_nameless || nameless;

    // Never the line itself: it may be a token.
    const std::string where = "has in line " + std::to_string(number) + " ";
    if (words >> more) fail(file, where + "more than a name and a token: give two words a line");
    if (!is_name(name)) {
      fail(file, where + "a name with other characters than letters, digits, '.', '_' and '-'");
    }
    if (token.size() < kShortestToken) {
      fail(file, where + "a token of less than 16 characters: use a longer one");
    }
    const bool taken =
        std::any_of(read.credentials_.begin(), read.credentials_.end(),
                    [&](const Credential& credential) { return credential.name == name; });
    if (taken) {
      fail(file, std::string(where)
                     .append("the name ")
                     .append(name)
                     .append(" again: give each token its own name"));
    }
    read.credentials_.push_back({name, digest_of(token)});
  }
  if (read.credentials_.empty()) fail(file, "holds no token: remove it to have a new one made");
  if (has_nameless && read.credentials_.size() > 1) {
    fail(file, "has a token without a name among others: write \"name token\" in each line");
  }
  return read;
}

std::optional<std::string> Credentials::owner_of(std::string_view token) const {
  const Digest given = digest_of(token);
  const Credential* owner = nullptr;
  for (const Credential& credential : credentials_) {  // all of them, whichever it is
    const bool same = CRYPTO_memcmp(given.data(), credential.digest.data(), given.size()) == 0;
    if (same) owner = &credential;
  }
  return owner == nullptr ? std::nullopt : std::optional(owner->name);
}

Credentials::Digest Credentials::digest_of(std::string_view token) {
  Digest digest{};
  SHA256(reinterpret_cast<const unsigned char*>(token.data()), token.size(), digest.data());
  return digest;
}

}  // namespace biotomy::acquisition
