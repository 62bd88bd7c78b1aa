#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "api/box.hpp"
#include "intake/server.hpp"

namespace adit::api {

/// A selection of log records.
struct LogFilter {
  int severity = 7;         // this severity and worse ones
  std::string text;         // part of the line, ignoring case; "": any
  std::uint64_t after = 0;  // only larger numbers

  bool lets(const LogRecord& record) const;
};

/// Reads `?level=warning&text=...&since=17`. Error 400: an invalid value.
icd::Checked<LogFilter> read_log_filter(const intake::RequestHead& head);

}  // namespace adit::api
