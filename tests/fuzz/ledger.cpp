// A ledger that is opened after damage to its files: bytes that are others, and an end that is cut off.
#include "ledger/ledger.hpp"

#include "folder.hpp"
#include "killed_ledger.hpp"

namespace adit::fuzz {

void try_ledger(Input input) {
  static const Folder folder;
  KilledLedger now = killed_ledger();
  now.damage(input);
  folder.clear();
  folder.put(kLedgerFile, now.file);
  folder.put(kLedgerLog, now.log);
  const bool is_cut = now.log.size() < killed_ledger().log.size();
  if (!is_cut) std::filesystem::resize_file(folder / kLedgerLog, now.log_size);
  const auto ledger = ledger::Ledger::open(folder.path());
  if (!ledger) return require(!ledger.error().what.empty());
  const auto reports = ledger->reports();
  require(reports.has_value() && ledger->runs().has_value());
  std::size_t same = 0;
  for (const dispatch::Report& report : *reports) {
    const auto was = now.reports.find(report.number);
    if (report.is_lost()) continue;
    // Nothing is there that was not, and what was sent is not sent again unasked.
    require(was != now.reports.end() && was->second.report == report.report);
    if (report == was->second)
      ++same;
    else
      require(report.state != dispatch::ReportState::Queued &&
              report.state != dispatch::ReportState::Rejected);
  }
  require(same == now.reports.size() || !ledger->damage().empty());
}

}  // namespace adit::fuzz
