#pragma once

#include <cstdint>
#include <expected>
#include <optional>
#include <string>

#include "ledger/database.hpp"

namespace adit::ledger {

/// What the ledger's file says of itself, without its log. While the ledger is open the file says that the
/// log is needed, and the first thing in the log takes that back: so the file alone says it just where the
/// log has more.
struct Mark {
  bool log_needed = false;
  std::int64_t log_size = 0;  // of the log's file, at least; 0: it grows as it is written
  std::int64_t highest = 0;   // number of a report in the file
};

struct MarkIsLost {};

/// As one transaction of the log.
Result<void> write_mark(Database& database, bool log_needed, std::int64_t log_size);

/// What the file at `path` says where nobody looks into its log; nothing: it has no mark, as one of
/// version 3. The error: its mark is not to be had, or not proven.
std::expected<std::optional<Mark>, MarkIsLost> mark_without_log(const std::string& path);

}  // namespace adit::ledger
