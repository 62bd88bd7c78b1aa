#pragma once

#include <string>

#include "update/last_update.hpp"
#include "update/proven.hpp"

/// State of adit-update that outlives a boot, in its state directory. A missing file reads as the default. A
/// damaged file is logged and reads as the default. save() returns true once the data survives a power cut.
namespace adit::applier {

update::LastUpdate load_last_update(const std::string& folder);
bool save(const std::string& folder, const update::LastUpdate& last_update);

update::Proven load_proven(const std::string& folder);
bool save(const std::string& folder, const update::Proven& proven);

}  // namespace adit::applier
