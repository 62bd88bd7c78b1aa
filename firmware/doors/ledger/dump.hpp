#pragma once

#include <functional>
#include <string>
#include <vector>

#include "store/directory.hpp"

namespace adit::ledger {

/// Prints each record and gap of a ledger's directory as a line of JSON. Does not change it, and works while
/// aditd writes. Returns sentences about damage. Error: a file cannot be read, or there is no ledger.
store::Result<std::vector<std::string>> dump(const std::string& directory,
                                             const std::function<void(const std::string&)>& print);

}  // namespace adit::ledger
