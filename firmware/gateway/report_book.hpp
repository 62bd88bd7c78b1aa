#pragma once

#include <cstdint>
#include <expected>
#include <map>
#include <string>
#include <vector>

#include "dispatch/report_life.hpp"
#include "icd/artifact_report.hpp"
#include "ledger/ledger.hpp"
#include "loop/loop.hpp"
#include "page/page.hpp"
#include "uplink/connection.hpp"

namespace adit::gateway {

/// All reports of this ledger and where each is in its life: in memory to be read, on disk before anything
/// follows (promise 1).
class ReportBook {
 public:
  static constexpr std::size_t kMostRows = 200;

  ReportBook(loop::Loop& loop, ledger::Ledger& ledger) : loop_(loop), ledger_(ledger) {}

  /// Takes up what the ledger holds from before; gives the numbers of the reports that wait, oldest first.
  /// What was being sent when the program ended is in doubt.
  std::expected<std::vector<std::int64_t>, std::string> open();

  /// A new report that waits, on disk. An error: it could not be written down.
  std::expected<std::int64_t, std::string> add(const icd::ArtifactReport& report, const std::string& sender);

  /// Takes the step that the table has for `event`, with a note for the operator. False: the step is not on
  /// disk (then a report that was to be sent still waits), or there is no such step.
  bool move(std::int64_t number, dispatch::ReportEvent event, const std::string& note);

  /// Remembers the Command Post's answer; it is written down with the next step.
  void set_answer(std::int64_t number, const uplink::Answered& answered);

  const ledger::Entry& entry(std::int64_t number) const { return entries_.at(number); }
  std::vector<page::ReportRow> rows() const;  // the last kMostRows, newest first
  std::size_t in_doubt() const;
  /// Why the last step could not be written, or "".
  const std::string& trouble() const { return trouble_; }

 private:
  loop::Loop& loop_;
  ledger::Ledger& ledger_;
  std::map<std::int64_t, ledger::Entry> entries_;
  std::string trouble_;
};

}  // namespace adit::gateway
