#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "api/route.hpp"
#include "api/source.hpp"
#include "intake/server.hpp"
#include "loop/loop.hpp"

namespace adit::api {

/// Format of a list of reports.
struct ListForm {
  std::string begin;
  std::string (*row)(const facts::ReportRow& row);
  std::string_view between, end;
};

/// A JSON array.
ListForm json_list();

class ReportLists {
 public:
  /// Both must outlive this object, and this object must outlive the loop's turns.
  ReportLists(loop::Loop& loop, Source& source) : loop_(loop), source_(source) {}

  /// Writes all reports of `run`, or of all runs, oldest first, and passes them to `done`, at once if there
  /// are few. Long lists are written in several turns of the loop, so that the loop can serve its sockets;
  /// each report has its state at that turn.
  void write(ListForm form, std::optional<std::int64_t> run,
             std::function<void(std::string list)> done) const;

 private:
  struct Listing;
  void continue_listing(const std::shared_ptr<Listing>& listing) const;

  loop::Loop& loop_;
  Source& source_;
};

/// Reports, and the operator's actions on them: README.md.
class ReportRoutes {
 public:
  /// All must outlive this object.
  ReportRoutes(const ReportLists& lists, Source& source, Operator& decisions)
      : lists_(lists), source_(source), operator_(decisions) {}

  void list(const Call& call) const;
  void csv(const Call& call) const;
  icd::Checked<ReportDetail> one(std::int64_t number) const;
  template <Action action>
  icd::Checked<intake::Answer> decide(std::int64_t number) {
    return decide(number, action);
  }
  icd::Checked<intake::Answer> compose(const std::string& body);
  icd::Checked<intake::Answer> correct(const Call& call);

 private:
  /// Completes `begun` with the list of the run in the request (its number, "present" or "all").
  void send_list(const Call& call, ListForm form, intake::Answer begun) const;
  icd::Checked<intake::Answer> decide(std::int64_t number, Action action);

  const ReportLists& lists_;
  Source& source_;
  Operator& operator_;
};

}  // namespace adit::api
