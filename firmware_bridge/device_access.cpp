#include "firmware_bridge/device_access.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <fstream>
#include <system_error>

#include <fcntl.h>
#include <grp.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

namespace biotomy::bridge {

namespace {

namespace fs = std::filesystem;

std::string group_of(const fs::path& device) {
  struct stat status {};
  if (::stat(device.c_str(), &status) != 0) return "?";
  const group* found = ::getgrgid(status.st_gid);
  return found != nullptr ? found->gr_name : std::to_string(status.st_gid);
}

std::string user_of_this_process() {
  const passwd* found = ::getpwuid(::geteuid());
  return found != nullptr ? found->pw_name : std::to_string(::geteuid());
}

bool is_number(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(),
                                      [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// Whether the process whose folder this is has the device open; false when it may not be known.
bool has_open(const fs::path& process, const fs::path& device) {
  std::error_code error;
  fs::directory_iterator files(process / "fd", error);
  for (const fs::directory_iterator end; !error && files != end; files.increment(error)) {
    std::error_code gone;
    if (fs::read_symlink(files->path(), gone) == device) return true;
  }
  return false;
}

std::string name_of(const fs::path& process) {
  std::ifstream file(process / "comm");
  std::string name;
  std::getline(file, name);
  return name + " (process " + process.filename().string() + ")";
}

}  // namespace

std::string no_access_text(const fs::path& device, const std::string& group,
                           const std::string& user) {
  const std::string refused = "the user " + user + " may not open " + device.string() + ": ";
  if (group == "root") {
    return refused +
           "it belongs to root alone; install the udev rules (packaging/60-biotomy.rules), then "
           "sudo udevadm control --reload && sudo udevadm trigger";
  }
  return refused + "it is for the group " + group + "; sudo usermod -aG " + group + " " + user +
         ", then log in anew";
}

std::optional<std::string> access_complaint(const fs::path& device) {
  if (::faccessat(AT_FDCWD, device.c_str(), R_OK | W_OK, AT_EACCESS) == 0) return std::nullopt;
  if (errno == EACCES) return no_access_text(device, group_of(device), user_of_this_process());
  return device.string() + " cannot be opened: " + std::generic_category().message(errno);
}

std::vector<std::string> programs_with(const fs::path& device, const fs::path& processes) {
  std::error_code error;
  const fs::path node = fs::canonical(device, error);
  std::vector<std::string> programs;
  if (error) return programs;
  const std::string own = std::to_string(::getpid());
  fs::directory_iterator entries(processes, error);
  for (const fs::directory_iterator end; !error && entries != end; entries.increment(error)) {
    const std::string number = entries->path().filename().string();
    if (!is_number(number) || number == own) continue;
    if (has_open(entries->path(), node)) programs.push_back(name_of(entries->path()));
  }
  return programs;
}

}  // namespace biotomy::bridge
