#include "acquisition/http/own_host_names.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <sstream>

#include <netinet/in.h>
#include <resolv.h>
#include <unistd.h>

#include "acquisition/http/lower_case.hpp"

namespace biotomy::acquisition {
namespace {

constexpr const char* kHostsFile = "/etc/hosts";

/// Of /etc/resolv.conf, which res_ninit reads; it asks nobody.
std::vector<std::string> resolver_domains() {
  struct __res_state state {};
  if (::res_ninit(&state) != 0) return {};
  std::vector<std::string> domains;
  for (const char* domain : state.dnsrch) {
    if (domain == nullptr) break;
    domains.emplace_back(domain);
  }
  ::res_nclose(&state);
  return domains;
}

}  // namespace

std::vector<std::string> names_of_host(const std::string& name, const std::string& hosts_file,
                                       const std::vector<std::string>& domains) {
  const std::string own = lower_case(name);
  const std::string plain = own.substr(0, own.find('.'));
  if (plain.empty()) return {};
  std::vector<std::string> names{plain, plain + ".local"};
  const auto add = [&](const std::string& other) {
    if (std::find(names.begin(), names.end(), other) == names.end()) names.push_back(other);
  };
  add(own);
  std::istringstream lines(lower_case(hosts_file));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::string address;
    words >> address;
    const std::vector<std::string> names_there{std::istream_iterator<std::string>(words), {}};
    const bool is_own = std::any_of(names_there.begin(), names_there.end(), [&](const auto& there) {
      return there == own || there == plain;
    });
    if (is_own) std::for_each(names_there.begin(), names_there.end(), add);
  }
  for (const std::string& domain : domains) {
    if (!domain.empty() && domain != ".") add(plain + '.' + lower_case(domain));
  }
  return names;
}

std::vector<std::string> own_host_names() {
  std::array<char, 256> name{};
  if (::gethostname(name.data(), name.size() - 1) != 0) return {};
  std::ifstream file(kHostsFile);
  return names_of_host(name.data(), {std::istreambuf_iterator<char>(file), {}}, resolver_domains());
}

}  // namespace biotomy::acquisition
