#pragma once

#include <string>

#include "ledger/database.hpp"

namespace adit::ledger {

struct Opened {
  Database database;
  std::string damage;  // a sentence about the file that was set aside, or ""
};

/// Opens `folder`/ledger.sqlite, made and set aside as Ledger::open() says, with its tables there.
Attempt<Opened> open_database(const std::string& folder);

}  // namespace adit::ledger
