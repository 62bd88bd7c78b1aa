#pragma once

#include <string>

#include "update/story.hpp"

namespace adit::applier {

/// What became of the last update, as it is kept in that folder; none where there is none, or a damaged one.
update::Story load_story(const std::string& folder);
/// True once it outlives a power cut.
bool save_story(const std::string& folder, const update::Story& story);

}  // namespace adit::applier
