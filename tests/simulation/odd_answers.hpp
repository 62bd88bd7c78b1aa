#pragma once

#include <string>

#include "simulation/random.hpp"

namespace adit::simulation {

/// The same answer in other words: in chunks, or behind an interim answer. Requires one that says its length.
std::string said_oddly(const std::string& answer, Random& random);
/// It says that it has fewer bytes than it has, or more.
std::string with_wrong_length(const std::string& answer, Random& random);
/// JSON, under a status that says that all is well.
std::string with_wrong_types(Random& random);
std::string redirect(Random& random);
/// Of something between the box and the Command Post.
std::string from_between(Random& random);

}  // namespace adit::simulation
