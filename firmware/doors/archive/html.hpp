#pragma once

#include <string>

namespace adit::archive {

/// The number with `digits` decimals.
std::string fixed(double number, int digits);

/// "1:02:03", or "-" for no time.
std::string lasted(double seconds);

}  // namespace adit::archive
