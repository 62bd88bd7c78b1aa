#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "api/source.hpp"
#include "loop/loop.hpp"

namespace adit::api {

/// Format of a list of reports.
struct ListForm {
  std::string begin;
  std::string (*row)(const ReportRow& row);
  std::string_view between, end;
};

/// A JSON array.
ListForm json_list();

/// Writes lists of reports.
class ReportLists {
 public:
  /// Both must outlive this object, and this object must outlive the loop's turns.
  ReportLists(loop::Loop& loop, const Source& source) : loop_(loop), source_(source) {}

  /// Writes all reports of `run`, or of all runs, oldest first, and passes them to `done`, at once if there
  /// are few. Long lists are written in several turns of the loop, so that the loop can serve its sockets;
  /// each report has its state at that turn.
  void write(ListForm form, std::optional<std::int64_t> run,
             std::function<void(std::string list)> done) const;

 private:
  struct Listing;
  void go_on(const std::shared_ptr<Listing>& listing) const;

  loop::Loop& loop_;
  const Source& source_;
};

}  // namespace adit::api
