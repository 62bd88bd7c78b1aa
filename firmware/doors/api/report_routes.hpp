#pragma once

#include <string>

#include "api/report_list.hpp"
#include "api/route.hpp"
#include "api/source.hpp"
#include "intake/server.hpp"

namespace adit::api {

/// Reports, and the operator's actions on them: README.md.
class ReportRoutes {
 public:
  /// All must outlive this object.
  ReportRoutes(const ReportLists& lists, const Source& source, Operator& decisions)
      : lists_(lists), source_(source), operator_(decisions) {}

  void list(const Call& call) const;
  void csv(const Call& call) const;
  intake::Answer one(std::int64_t number) const;
  template <Action action>
  intake::Answer decide(std::int64_t number) {
    return decide(number, action);
  }
  intake::Answer compose(const std::string& body);
  intake::Answer correct(const Call& call);

 private:
  /// Completes `begun` with the list of the run in the request (its number, "present" or "all").
  void listed(const Call& call, ListForm form, intake::Answer begun) const;
  intake::Answer decide(std::int64_t number, Action action);

  const ReportLists& lists_;
  const Source& source_;
  Operator& operator_;
};

}  // namespace adit::api
