#pragma once

#include <string>

#include "api/box.hpp"

namespace adit::api {

/// What the metrics are made of.
struct Measured {
  RunView view;
  ReportCounts reports;  // of all runs
  Usage usage;
  About about;
  std::uint64_t operators = 0, viewers = 0;  // sessions
};

/// /metrics: each metric with its HELP and TYPE. README.md says what the names are made of.
std::string write_metrics(const Measured& measured);

}  // namespace adit::api
