#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "api/box.hpp"
#include "intake/server.hpp"

namespace adit::api {

/// What of the log is asked for.
struct LogFilter {
  int severity = 7;         // and all that is worse
  std::string text;         // in the record's line, in whatever letters; "": any
  std::uint64_t after = 0;  // of this number

  bool lets(const LogRecord& record) const;
};

/// Of `?level=warning&text=...&since=17`; 400 where a word is none.
icd::Checked<LogFilter> read_log_filter(const intake::RequestHead& head);

}  // namespace adit::api
