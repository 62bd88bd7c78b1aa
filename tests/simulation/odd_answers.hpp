#pragma once

#include <cstdint>
#include <string>

#include "simulation/random.hpp"

namespace adit::simulation {

/// The same answer, chunked or after an interim answer. Requires one with a length.
std::string in_another_form(const std::string& answer, Random& random);
std::string with_wrong_length(const std::string& answer, Random& random);
/// A 200 with unrelated JSON.
std::string with_wrong_types(Random& random);
std::string redirect(Random& random);
/// An answer of a proxy between the box and the Command Post. `fields`: more lines of its head.
std::string from_between(Random& random, const std::string& fields);
/// The field Retry-After: so many seconds after `now`, which is in seconds since 1970, or as a date beside
/// the server's own Date, which is months off, or beyond int32.
std::string retry_after(Random& random, double now, std::uint64_t seconds);
/// The same answer under Content-Encoding: gzip. Requires one with a length.
std::string gzipped(const std::string& answer);

}  // namespace adit::simulation
