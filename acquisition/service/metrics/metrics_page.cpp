#include "acquisition/service/metrics/metrics_page.hpp"

#include <utility>

#include "acquisition/service/metrics/status_metrics.hpp"

namespace biotomy::acquisition {
namespace {

using enum MetricType;

std::vector<MetricFamily> link_families(const LinkCounts& link) {
  MetricFamily calls{"biotomy_link_calls_total", counter,
                     "Calls to the controller, by what was asked of it."};
  MetricFamily errors{"biotomy_link_errors_total", counter,
                      "Calls to the controller that failed, by what was asked and by how."};
  for (const auto& [call, count] : link.calls()) {
    calls.samples.push_back({{{"call", call}}, static_cast<double>(count)});
  }
  for (const auto& [key, count] : link.errors()) {
    errors.samples.push_back(
        {{{"call", key.first}, {"error", key.second}}, static_cast<double>(count)});
  }
  return {std::move(calls),
          std::move(errors),
          {"biotomy_link_commands_repeated_total",
           counter,
           "Commands that were handed over again, as the controller had not received them.",
           {{{}, static_cast<double>(link.repeated_commands())}}}};
}

std::vector<MetricFamily> courier_families(const std::vector<Courier::Figures>& couriers) {
  MetricFamily waiting{"biotomy_notifications_waiting", gauge,
                       "Messages that are not delivered yet, by way."};
  MetricFamily delivered{"biotomy_notifications_delivered_total", counter,
                         "Messages that were delivered, by way."};
  MetricFamily failed{"biotomy_notification_failures_total", counter,
                      "Attempts to deliver a message that failed, by way."};
  MetricFamily dropped{"biotomy_notifications_dropped_total", counter,
                       "Messages that were given up since too many waited, by way."};
  for (const Courier::Figures& figures : couriers) {
    const MetricLabels labels = {{"channel", figures.channel}};
    waiting.samples.push_back({labels, static_cast<double>(figures.waiting)});
    delivered.samples.push_back({labels, static_cast<double>(figures.delivered)});
    failed.samples.push_back({labels, static_cast<double>(figures.failed_attempts)});
    dropped.samples.push_back({labels, static_cast<double>(figures.dropped)});
  }
  return {std::move(waiting), std::move(delivered), std::move(failed), std::move(dropped)};
}

}  // namespace

std::string metrics_page(const JobStatus& status, const RunMetrics& run, const LinkCounts& link,
                         const std::vector<Courier::Figures>& couriers) {
  std::vector<MetricFamily> families = status_metrics(status);
  for (std::vector<MetricFamily>& more : std::vector<std::vector<MetricFamily>>{
           run.families(), link_families(link), courier_families(couriers)}) {
    for (MetricFamily& family : more) families.push_back(std::move(family));
  }
  return exposition(families);
}

}  // namespace biotomy::acquisition
