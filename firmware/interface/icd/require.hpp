#pragma once

#include <cstdio>
#include <cstdlib>
#include <source_location>

namespace adit::icd {

/// Asserts a precondition ("Requires" in a comment), in every build. If it fails, the program ends, because
/// its further behaviour would be unknown and a restart loses nothing. Only for cheap checks.
inline void require(bool holds, std::source_location where = std::source_location::current()) {
  if (holds) [[likely]]
    return;
  std::fprintf(stderr, "%s, line %u: assertion failed\n", where.function_name(),
               static_cast<unsigned>(where.line()));
  std::abort();
}

}  // namespace adit::icd
