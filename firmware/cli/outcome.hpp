#pragma once

#include <string>

namespace adit::cli {

enum class Exit : int { Fine = 0, Attention = 1, Unable = 2 };

/// What a command prints and how it ends.
struct Outcome {
  Exit exit = Exit::Fine;
  std::string out, err;
};

}  // namespace adit::cli
