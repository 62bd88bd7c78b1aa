#pragma once

#include <string>

#include "simulation/random.hpp"

namespace adit::simulation {

/// The same answer, chunked or after an interim answer. Requires one with a length.
std::string in_another_form(const std::string& answer, Random& random);
std::string with_wrong_length(const std::string& answer, Random& random);
/// A 200 with unrelated JSON.
std::string with_wrong_types(Random& random);
std::string redirect(Random& random);
/// An answer of a proxy between the box and the Command Post.
std::string from_between(Random& random);

}  // namespace adit::simulation
