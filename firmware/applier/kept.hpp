#pragma once

#include <string>

#include "update/last_update.hpp"
#include "update/proven.hpp"

/// What adit-update keeps over starts of the machine, in its state folder. What is not there, or damaged, is
/// none. Saving gives true once it outlives a power cut.
namespace adit::applier {

update::LastUpdate load_last_update(const std::string& folder);
bool save(const std::string& folder, const update::LastUpdate& last_update);

update::Proven load_proven(const std::string& folder);
bool save(const std::string& folder, const update::Proven& proven);

}  // namespace adit::applier
