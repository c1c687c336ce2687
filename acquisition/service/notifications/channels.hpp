#pragma once

#include <memory>
#include <vector>

#include "acquisition/service/notifications/channel.hpp"
#include "acquisition/service/notify_section.hpp"

namespace biotomy::acquisition {

/// The ways that the configuration names. Throws SecretFileError when the webhook's token cannot be
/// read.
std::vector<std::unique_ptr<Channel>> make_channels(const NotifyConfiguration& notify);

}  // namespace biotomy::acquisition
