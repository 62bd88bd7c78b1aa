#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "dispatch/report.hpp"
#include "target.hpp"

namespace adit::fuzz {

inline constexpr const char *kLedgerFile = "ledger.sqlite", *kLedgerLog = "ledger.sqlite-wal";

/// The files of a ledger whose program was killed, and what was in it. Up to `log_size` the log has zeros.
struct KilledLedger {
  std::string file, log;
  std::size_t log_size = 0;
  std::map<std::int64_t, dispatch::Report> reports;

  /// Of each five bytes three say where, among the file and its log, and one what stands there now; 0xff in
  /// the fourth cuts that file off there.
  void damage(Input input);
};

/// Reports on their way, made once.
const KilledLedger& killed_ledger();

}  // namespace adit::fuzz
