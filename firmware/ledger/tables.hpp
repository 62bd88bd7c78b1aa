#pragma once

#include "ledger/database.hpp"

namespace adit::ledger {

/// Whether the file may be touched at all: an error where a later version of Adit wrote it, and a failure
/// with `damaged` where it is no ledger. Writes nothing.
Result<void> check_version(Database& database);

/// Makes the tables of this version: in an empty file, or from those of an earlier version. All or nothing.
Result<void> make_tables(Database& database);

}  // namespace adit::ledger
