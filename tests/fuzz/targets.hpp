#pragma once

#include <span>
#include <string_view>

#include "target.hpp"

namespace adit::fuzz {

/// A parser that meets input, and the laws that hold whatever that is. Its seeds are in seeds/NAME.
struct Target {
  const char* name;
  void (*try_input)(Input input);
  /// Mutated inputs in a short turn, as many as take a second or two under the sanitizers.
  int short_turn = 2000;
};

std::span<const Target> targets();

/// Null where there is none.
const Target* target_named(std::string_view name);

}  // namespace adit::fuzz
