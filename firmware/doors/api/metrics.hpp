#pragma once

#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "api/box.hpp"

namespace adit::api {

/// Metrics in Prometheus' text exposition format 0.0.4. Add the samples of a metric directly after it.
class Exposition {
 public:
  static constexpr const char* kContentType = "text/plain; version=0.0.4; charset=utf-8";
  using Label = std::pair<std::string_view, std::string_view>;

  /// Begins a metric: a counter if its name ends in "_total", otherwise a gauge.
  void begin(std::string_view name, std::string_view help);
  /// Adds a sample to the last metric. Each set of labels may occur once.
  void sample(std::initializer_list<Label> labels, auto value) { sample(std::span(labels), value); }
  void sample(std::span<const Label> labels, auto value) { write_sample(labels, static_cast<double>(value)); }
  /// A metric with one sample.
  void add(std::string_view name, std::string_view help, auto value) {
    begin(name, help);
    sample({}, value);
  }

  const std::string& text() const { return text_; }

 private:
  void write_sample(std::span<const Label> labels, double value);

  std::string text_, name_;
};

struct MetricsInput {
  RunView view;
  ReportCounts reports;  // of all runs
  Usage usage;
  About about;
  std::uint64_t operators = 0, viewers = 0;  // sessions
};

/// /metrics: each metric with HELP and TYPE. Names: README.md.
std::string write_metrics(const MetricsInput& measured);

}  // namespace adit::api
