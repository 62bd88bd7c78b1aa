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

/// How a list of reports is written.
struct ListForm {
  std::string begin;
  std::string (*row)(const ReportRow& row);
  std::string_view between, end;
};

/// An array of JSON.
ListForm json_list();

/// Writes lists of reports.
class ReportLists {
 public:
  /// Both outlive this, and this the turns of the loop.
  ReportLists(loop::Loop& loop, const Source& source) : loop_(loop), source_(source) {}

  /// Writes all reports of `run`, or of all runs, oldest first, and calls `done` with them: at once where
  /// they are few. Of thousands it writes some in each turn of the loop, each as it is then: all at once,
  /// they would keep the loop from its sockets.
  void write(ListForm form, std::optional<std::int64_t> run,
             std::function<void(std::string list)> done) const;

 private:
  struct Listing;
  void go_on(const std::shared_ptr<Listing>& listing) const;

  loop::Loop& loop_;
  const Source& source_;
};

}  // namespace adit::api
