#pragma once

#include <string>

#include "update/last_update.hpp"

namespace adit::applier {

/// What became of the last update, as it is kept in that folder; none where there is none, or a damaged one.
update::LastUpdate load_last_update(const std::string& folder);
/// True once it outlives a power cut.
bool save_last_update(const std::string& folder, const update::LastUpdate& last_update);

}  // namespace adit::applier
