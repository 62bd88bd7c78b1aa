#pragma once

#include <string>

#include "ledger/carving.hpp"
#include "ledger/database.hpp"

namespace adit::ledger {

/// Puts what was carved from a damaged ledger into `database`, whose tables are there and empty, so that
/// nothing of it is sent again unasked:
/// - a report that is answered, settled or withdrawn stays so. Any other may have been sent since: it becomes
/// in
///   doubt, and only the operator can judge it.
/// - for reports whose numbers were given out and that are not there, one stands in doubt (dispatch::Report::
///   is_lost()), under the last of their numbers.
/// - `tail_lost`: later reports may have been there too; the one that stands for them has a round number,
/// after
///   which new ones go on.
/// - no run's count of reports proves anything any more.
/// Gives a sentence about what was taken over and what is missing.
Result<std::string> salvage(Database& database, const Carved& carved, bool tail_lost);

}  // namespace adit::ledger
