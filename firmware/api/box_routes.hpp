#pragma once

#include <memory>
#include <string>

#include "api/box.hpp"
#include "api/entrance.hpp"
#include "api/log_filter.hpp"
#include "api/redacted.hpp"
#include "api/report_list.hpp"
#include "api/source.hpp"
#include "intake/server.hpp"

namespace adit::api {

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
