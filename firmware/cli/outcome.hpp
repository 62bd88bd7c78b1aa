#pragma once

#include <string>

namespace adit::cli {

enum class Exit : int { Fine = 0, Attention = 1, Unable = 2 };

/// A command's output and exit status.
struct Outcome {
  Exit exit = Exit::Fine;
  std::string out, err;
};

}  // namespace adit::cli
