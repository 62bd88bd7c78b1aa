#pragma once

#include <expected>
#include <string>

#include "update/last_update.hpp"

/// State of adit-update that outlives a boot, in its state directory. A missing file reads as the default. An
/// error says what cannot be read, and why. save() returns true once the data survives a power cut.
namespace adit::applier {

std::expected<update::LastUpdate, std::string> load_last_update(const std::string& folder);
bool save(const std::string& folder, const update::LastUpdate& last_update);

std::expected<update::Proven, std::string> load_proven(const std::string& folder);
bool save(const std::string& folder, const update::Proven& proven);

}  // namespace adit::applier
