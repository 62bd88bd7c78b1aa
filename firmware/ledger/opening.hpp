#pragma once

#include <string>

#include "ledger/database.hpp"
#include "loop/file_descriptor.hpp"

namespace adit::ledger {

struct Opened {
  loop::FileDescriptor lock;  // of the folder, for as long as the database is open
  Database database;
  std::string damage;  // a sentence about what was found damaged, or ""
};

/// Opens `folder`/ledger.sqlite, made, put right and salvaged as Ledger::open() says, with its tables there.
Result<Opened> open_database(const std::string& folder);

/// At this many pages the log is taken over into the file.
inline constexpr int kPagesOfLog = 960;
/// Takes the log over into the file, so that it is written from its start again. False: it is not, or not
/// all of it.
bool take_over_log(Database& database);

}  // namespace adit::ledger
