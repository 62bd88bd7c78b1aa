#pragma once

#include <functional>
#include <string>
#include <vector>

#include "store/error.hpp"

namespace adit::ledger {

/// Gives each record in a ledger's directory, and each gap, as a line of JSON. Changes nothing, and may be
/// called while aditd writes. Sentences about damage, if there is any; an error if a file cannot be read or
/// no ledger is there.
store::Result<std::vector<std::string>> dump(const std::string& directory,
                                             const std::function<void(const std::string&)>& print);

}  // namespace adit::ledger
