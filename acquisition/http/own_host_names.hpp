#pragma once

#include <string>
#include <vector>

namespace biotomy::acquisition {

/// The names that this computer has: its own, that with its domain, and that with ".local"; lower
/// case. No name server is asked, as one that is dead would hold up the start for half a minute:
/// the domain is that of /etc/hosts, or one in which the resolver looks for short names.
std::vector<std::string> own_host_names();

/// The same of a computer that calls itself `name`, with what its /etc/hosts says and the domains
/// in which its resolver looks.
std::vector<std::string> names_of_host(const std::string& name, const std::string& hosts_file,
                                       const std::vector<std::string>& domains);

}  // namespace biotomy::acquisition
