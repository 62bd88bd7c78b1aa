#pragma once

#include <functional>
#include <limits>
#include <string>

#include "codec/messages.hpp"

namespace adit::codec::test {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A change of a valid message, and the expected answer by a section of the ICD.
struct IcdRow {
  const char* section;
  std::function<void(json&)> change;
  std::string sentence;
};

}  // namespace adit::codec::test
