#pragma once

#include <string>

namespace adit::archive {

/// With so many digits behind the point.
std::string fixed(double number, int digits);

/// "1:02:03", of seconds; "-" where there are none.
std::string lasted(double seconds);

}  // namespace adit::archive
