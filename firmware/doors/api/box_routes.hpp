#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "api/box.hpp"
#include "api/entrance.hpp"
#include "api/redacted.hpp"
#include "api/report_list.hpp"
#include "api/source.hpp"
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

/// The box: metrics, log, about and support bundle. Routes: README.md.
class BoxRoutes {
 public:
  /// All must outlive this object, and the work of `box`.
  BoxRoutes(const Source& source, const ReportLists& lists, Box& box, Entrance& entrance,
            const SharedRedaction& redaction, loop::Loop& loop)
      : source_(source), lists_(lists), box_(box), entrance_(entrance), redaction_(redaction), loop_(loop) {}

  intake::Answer metrics() const;
  intake::Answer log(const intake::RequestHead& head) const;
  intake::Answer log_text(const intake::RequestHead& head) const;
  intake::Answer about() const;
  void bundle(const Call& call);

 private:
  void pack(const std::shared_ptr<intake::Responder>& responder, std::string reports);
  std::string about_json() const;
  std::string metrics_text() const;
  std::string log_lines(const LogFilter& filter) const;

  const Source& source_;
  const ReportLists& lists_;
  Box& box_;
  Entrance& entrance_;
  const SharedRedaction& redaction_;  // for the bundle; Api redacts other answers
  loop::Loop& loop_;
};

}  // namespace adit::api
