#include "acquisition/service/notify_section.hpp"

#include "acquisition/service/configuration_keys.hpp"
#include "acquisition/service/notifications/webhook_channel.hpp"

namespace biotomy::acquisition {

using bridge::CheckedTable;

NotifyConfiguration read_notify(const CheckedTable& table) {
  NotifyConfiguration notify;
  notify.command = table.get(bridge::TextsKey{
      .name = "command",
      .fallback = std::vector<std::string>{},
      .description = "program and arguments, started without a shell; the message is JSON on its "
                     "standard input"});
  if (!notify.command.empty() && notify.command.front().empty()) {
    table.reject("command", "the first text must name the program");
  }
  notify.webhook =
      optional_text(table, "webhook", "URL, http:// or https://, that the message is sent to");
  if (!notify.webhook.empty() && !split_url(notify.webhook)) {
    table.reject("webhook", "must be a URL such as \"https://example.org/hook\"");
  }
  const std::string token_file = optional_text(
      table, "webhook_token_file", "a file with the token that the webhook wants (Bearer)");
  if (!token_file.empty()) notify.webhook_token_file = table.resolve(token_file);

  NotifierSettings& notifier = notify.notifier;
  notifier.queue = table.resolve(table.get(bridge::TextKey{
      .name = "queue",
      .fallback = "notifications",
      .description = "folder of the messages that are not delivered yet; made when missing"}));
  notifier.courier.keep = count(table, "keep", notifier.courier.keep, 1, 10000,
                                "messages that wait at most, for each way; the oldest go");
  notifier.courier.time_out = duration(table, "timeout_ms", notifier.courier.time_out,
                                       "an attempt that takes longer has failed", 100, 600000);
  notifier.courier.first_retry =
      duration(table, "first_retry_ms", notifier.courier.first_retry,
               "after a failure it is tried again; the wait doubles with each");
  notifier.courier.longest_retry =
      duration(table, "longest_retry_ms", notifier.courier.longest_retry, "the longest wait");
  if (notifier.courier.longest_retry < notifier.courier.first_retry) {
    table.reject("longest_retry_ms", "must not be below first_retry_ms");
  }
  notifier.fold_window =
      duration(table, "fold_window_ms", notifier.fold_window,
               "the same trouble again within so long is counted, and told once at its end");

  WatchLimits& watch = notify.watch;
  watch.low_disk_layers =
      count(table, "low_disk_layers", static_cast<int>(watch.low_disk_layers), 0, 1000000,
            "with room for fewer layers, and fewer than are still to come, "
            "the disk is low");
  watch.stall_factor = number(table, "stall_factor", watch.stall_factor, "", 1.5, 1000.0,
                              "a run without a new layer for so many times the usual time of a "
                              "layer is stalled");
  watch.stall_minimum =
      duration(table, "stall_minimum_ms", watch.stall_minimum, "but never sooner than this");
  watch.stall_first = duration(table, "stall_first_ms", watch.stall_first,
                               "likewise while the run has no two layers to know its pace from");
  return notify;
}

}  // namespace biotomy::acquisition
