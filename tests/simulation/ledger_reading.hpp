#pragma once

#include <string>
#include <vector>

#include "dispatch/report.hpp"

namespace adit::simulation {

struct LedgerReading {
  std::vector<dispatch::Report> reports;  // by number
  std::size_t missing = 0;                // records
};
/// Reads the files in a ledger's directory as firmware/doors/store/README.md and
/// firmware/doors/ledger/README.md describe them, without the firmware's code.
LedgerReading read_ledger(const std::string& directory);
/// Whether an older copy of the directory lacks a record or a log.
bool lacks_records(const std::string& copy, const std::string& directory);

}  // namespace adit::simulation
