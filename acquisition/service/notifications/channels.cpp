#include "acquisition/service/notifications/channels.hpp"

#include <string>

#include "acquisition/service/notifications/command_channel.hpp"
#include "acquisition/service/notifications/webhook_channel.hpp"
#include "acquisition/service/secret_file.hpp"

namespace biotomy::acquisition {

std::vector<std::unique_ptr<Channel>> make_channels(const NotifyConfiguration& notify) {
  std::vector<std::unique_ptr<Channel>> channels;
  if (!notify.command.empty()) {
    channels.push_back(std::make_unique<CommandChannel>(notify.command));
  }
  if (!notify.webhook.empty()) {
    std::string token;
    if (!notify.webhook_token_file.empty()) {
      token = read_secret_file(notify.webhook_token_file, "the webhook's token file");
      token.erase(token.find_last_not_of(" \t\r\n") + 1);
    }
    channels.push_back(std::make_unique<WebhookChannel>(*split_url(notify.webhook), token));
  }
  return channels;
}

}  // namespace biotomy::acquisition
