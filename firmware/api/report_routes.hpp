#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "api/source.hpp"
#include "intake/server.hpp"

namespace adit::api {

/// What is known of reports, and the operator's actions: README.md.
class ReportRoutes {
 public:
  /// `changed` is called after each action. All outlive this.
  ReportRoutes(const Source& source, Operator& judge, std::function<void()> changed);

  intake::Answer list(const intake::RequestHead& head) const;
  intake::Answer csv(const intake::RequestHead& head) const;
  intake::Answer one(std::int64_t number) const;
  template <Action action>
  intake::Answer judge(std::int64_t number) {
    return judge(number, action);
  }
  intake::Answer compose(const std::string& body);

 private:
  /// Of one run: its number, "present" or, as "", "all".
  icd::Checked<std::vector<ReportRow>> listed(std::string_view run) const;
  intake::Answer judge(std::int64_t number, Action action);
  intake::Answer composed(const std::string& body);

  const Source& source_;
  Operator& operator_;
  std::function<void()> changed_;
};

}  // namespace adit::api
