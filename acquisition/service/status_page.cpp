#include "acquisition/service/status_page.hpp"

#include <cmath>
#include <sstream>

namespace biotomy::acquisition {
namespace {

constexpr const char* kHead = R"html(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="refresh" content="2">
<title>Biotomy</title>
<style>
body { font: 16px/1.5 system-ui, sans-serif; margin: 2rem auto; max-width: 44rem; padding: 0 1rem;
       color: #1c2430; background: #f6f7f9; }
th { text-align: left; font-weight: 600; padding-right: 2rem; vertical-align: top; }
.alarm { background: #8c1d18; color: #fff; padding: .75rem 1rem; border-radius: .4rem; }
</style>
</head>
<body>
<main>
<h1>Biotomy</h1>
)html";

class Page {
 public:
  Page() { text_ << kHead; }

  void alarm(const Alarm& alarm) {
    text_ << "<p class=\"alarm\" role=\"alert\">" << html_escaped(alarm.cause) << "<br>since "
          << html_escaped(alarm.since);
    if (alarm.state != JobState::faulted) text_ << ", while " << to_string(alarm.state);
    text_ << "</p>\n";
  }

  void begin_table() { text_ << "<table>\n"; }

  template <typename Value>
  void row(const char* name, const Value& value) {
    std::ostringstream shown;
    shown << value;
    text_ << "<tr><th scope=\"row\">" << name << "</th><td>" << html_escaped(shown.str())
          << "</td></tr>\n";
  }

  std::string finish() {
    text_ << "</table>\n</main>\n</body>\n</html>\n";
    return text_.str();
  }

 private:
  std::ostringstream text_;
};

std::string safety_text(bool estop_pressed, bool door_open) {
  if (estop_pressed) return "e-stop pressed";
  if (door_open) return "door open";
  return "good";
}

}  // namespace

std::string status_page(const JobStatus& status) {
  Page page;
  if (status.alarm) page.alarm(*status.alarm);
  page.begin_table();
  page.row("State", to_string(status.state));
  if (!status.waiting_for.empty()) page.row("Step", status.waiting_for);
  page.row("Job", status.job);
  page.row("Sample", status.sample);
  page.row("Layers stored",
           std::to_string(status.committed) + " of " + std::to_string(status.layers));
  if (status.layer > 0) {
    page.row("In work", "layer " + std::to_string(status.layer) + ", attempt " +
                            std::to_string(status.attempt));
  }
  if (status.seconds_left) {
    page.row("Time left", std::to_string(std::lround(*status.seconds_left / 60.0)) + " min");
  }
  page.row("Layers in the volume", status.volume.layers_present);
  if (!status.volume.failure.empty()) page.row("Volume", status.volume.failure);
  if (status.disk_left_layers) page.row("Room on the disk for layers", *status.disk_left_layers);
  page.row("Controller", status.controller_answers ? "answers" : "does not answer");
  page.row("Safety lines", safety_text(status.lines.estop_pressed, status.lines.door_open));
  if (status.stage) {
    page.row("Feed, µm", status.stage->feed.value);
    page.row("Column, µm", status.stage->column.value);
    page.row("Block, °C", status.stage->block_temperature_c);
  }
  if (status.last_layer) {
    for (const Metric& metric : status.last_layer->assessment.metrics) {
      page.row(metric.name.c_str(), metric.value);
    }
  }
  return page.finish();
}

std::string html_escaped(const std::string& text) {
  std::string escaped;
  for (const char character : text) {
    switch (character) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += character;
    }
  }
  return escaped;
}

}  // namespace biotomy::acquisition
