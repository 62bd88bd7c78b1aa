#pragma once

#include <cstdio>
#include <cstdlib>
#include <source_location>

namespace adit::icd {

/// What a function requires of its callers ("Requires" in its comment). Where it does not hold, the program
/// ends, in every build: nobody has thought of what it would do next, and a restart loses nothing. Only for
/// what is cheap to check.
inline void require(bool holds, std::source_location where = std::source_location::current()) {
  if (holds) [[likely]]
    return;
  std::fprintf(stderr, "%s, line %u: assertion failed\n", where.function_name(),
               static_cast<unsigned>(where.line()));
  std::abort();
}

}  // namespace adit::icd
