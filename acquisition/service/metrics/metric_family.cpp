#include "acquisition/service/metrics/metric_family.hpp"

#include <array>
#include <cmath>
#include <cstdio>

namespace biotomy::acquisition {
namespace {

/// A text with the characters written out that would end it; quotes only in values of labels.
std::string escaped(const std::string& text, bool quotes) {
  std::string result;
  for (const char character : text) {
    if (character == '\n') {
      result += "\\n";
      continue;
    }
    if (character == '\\' || (quotes && character == '"')) result += '\\';
    result += character;
  }
  return result;
}

std::string number(double value) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value > 0 ? "+Inf" : "-Inf";
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.10g", value);
  return text.data();
}

std::string label_list(const MetricLabels& labels) {
  std::string text;
  for (const auto& [name, value] : labels) {
    text += (text.empty() ? "{" : ",") + name + "=\"" + escaped(value, true) + "\"";
  }
  return text.empty() ? "" : text + "}";
}

void write_line(std::string& text, const std::string& name, const MetricLabels& labels,
                const std::string& value) {
  text += name + label_list(labels) + " " + value + "\n";
}

void write_histogram(std::string& text, const std::string& name, const HistogramSample& sample) {
  for (std::size_t i = 0; i < sample.bounds.size(); ++i) {
    MetricLabels labels = sample.labels;
    labels.emplace_back("le", number(sample.bounds[i]));
    write_line(text, name + "_bucket", labels, std::to_string(sample.counts.at(i)));
  }
  MetricLabels labels = sample.labels;
  labels.emplace_back("le", "+Inf");
  write_line(text, name + "_bucket", labels, std::to_string(sample.count));
  write_line(text, name + "_sum", sample.labels, number(sample.sum));
  write_line(text, name + "_count", sample.labels, std::to_string(sample.count));
}

}  // namespace

const char* to_string(MetricType type) {
  switch (type) {
    case MetricType::counter:
      return "counter";
    case MetricType::gauge:
      return "gauge";
    case MetricType::histogram:
      return "histogram";
  }
  return "untyped";
}

std::string exposition(const std::vector<MetricFamily>& families) {
  std::string text;
  for (const MetricFamily& family : families) {
    text += "# HELP " + family.name + " " + escaped(family.help, false) + "\n";
    text += "# TYPE " + family.name + " " + to_string(family.type) + "\n";
    for (const MetricSample& sample : family.samples) {
      write_line(text, family.name, sample.labels, number(sample.value));
    }
    for (const HistogramSample& sample : family.histograms) {
      write_histogram(text, family.name, sample);
    }
  }
  return text;
}

}  // namespace biotomy::acquisition
