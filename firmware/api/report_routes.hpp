#pragma once

#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "api/source.hpp"
#include "intake/server.hpp"

namespace adit::api {

/// What is known of reports, and the operator's actions, for those whom Entrance let in: README.md.
///
/// An action is asked for by POST with JSON as its Content-Type: a web page from elsewhere, in a browser of
/// the team's network, cannot send that without a preflight, which is refused.
class ReportRoutes {
 public:
  /// `changed` is called after each action. All outlive this.
  ReportRoutes(const Source& source, Operator& judge, std::function<void()> changed);

  static bool has(std::string_view path);
  /// Requires has(head.path()).
  std::unique_ptr<intake::BodySink> open(const intake::RequestHead& head,
                                         std::shared_ptr<intake::Responder> responder);

 private:
  intake::Answer shown(const intake::RequestHead& head) const;
  /// Of one run: its number, "present" or, as "", "all".
  icd::Checked<std::vector<ReportRow>> listed(std::string_view run) const;
  intake::Answer judge(std::int64_t number, Action action);
  /// Of the body of a composed report.
  intake::Answer report(std::string_view body);
  intake::Answer begin_run();

  const Source& source_;
  Operator& operator_;
  std::function<void()> changed_;
};

}  // namespace adit::api
