#pragma once

#include <string>

#include "ledger/database.hpp"

namespace adit::ledger {

struct Opened {
  Database database;
  std::string damage;  // a sentence about what was found damaged, or ""
};

/// Opens `folder`/ledger.sqlite, made, put right and salvaged as Ledger::open() says, with its tables there.
/// Called with the folder locked: a log that another process writes looks damaged.
Result<Opened> open_database(const std::string& folder);

/// At this many pages the log is taken over into the file.
inline constexpr int kPagesOfLog = 960;
/// Takes the log over into the file, so that it is written from its start again. False: it is not, or not
/// all of it.
bool take_over_log(Database& database);

}  // namespace adit::ledger
