// What is had of a ledger's files before SQLite sees them: its log put right, and rows carved out of both.
#include "killed_ledger.hpp"
#include "ledger/carving.hpp"
#include "ledger/log_file.hpp"
#include "target.hpp"

namespace adit::fuzz {
namespace {

/// What was put right is right.
void repair_log(std::string log) {
  std::string repaired = log;
  const ledger::LogReading reading = ledger::read_log(repaired);
  require(repaired.size() == log.size());
  for (const auto& repair : reading.repairs) log.at(repair.at) = repair.byte;
  require(log == repaired && ledger::read_log(repaired).repairs.empty() && log == repaired);
}

}  // namespace

void try_log(Input input) {
  repair_log(std::string(input));
  (void)ledger::carve(input, input);

  KilledLedger now = killed_ledger();
  now.damage(input);
  repair_log(now.log);
  const ledger::Carved carved = ledger::carve(now.file, now.log);
  for (const auto& [number, row] : carved.reports) require(now.reports.contains(number));
}

}  // namespace adit::fuzz
