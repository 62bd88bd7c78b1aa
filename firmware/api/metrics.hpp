#pragma once

#include <string>

#include "api/box.hpp"

namespace adit::api {

/// Input of the metrics.
struct Measured {
  RunView view;
  ReportCounts reports;  // of all runs
  Usage usage;
  About about;
  std::uint64_t operators = 0, viewers = 0;  // sessions
};

/// /metrics: each metric with HELP and TYPE. Names: README.md.
std::string write_metrics(const Measured& measured);

}  // namespace adit::api
