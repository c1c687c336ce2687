#include "acquisition/service/device_wait.hpp"

#include <utility>

#include "acquisition/log.hpp"

namespace biotomy::acquisition {
namespace {

/// For the next try, too: a name server that does not answer takes its time.
constexpr std::chrono::milliseconds kStartExtension{120000};

}  // namespace

DeviceWait::DeviceWait(std::chrono::milliseconds limit, ServiceManager& systemd, Clock clock,
                       Pause pause)
    : systemd_(systemd),
      clock_(std::move(clock)),
      pause_(std::move(pause)),
      until_(clock_() + limit) {}

void DeviceWait::tell(const std::string& missing) {
  systemd_.extend(kStartExtension);
  if (missing == told_) return;
  told_ = missing;
  const auto left = std::chrono::ceil<std::chrono::seconds>(until_ - clock_());
  systemd_.status("waits for a device: " + missing);
  log_warning("daemon",
              "waits up to " + std::to_string(left.count()) + " s for a device: " + missing);
}

}  // namespace biotomy::acquisition
