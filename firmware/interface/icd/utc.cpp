#include "icd/utc.hpp"

#include <ctime>

namespace adit::icd {

std::string utc(double seconds) {
  constexpr double kMost = 1e11;
  if (!(seconds > 0 && seconds <= kMost)) return "";
  const auto whole = static_cast<std::time_t>(seconds);
  std::tm parts{};
  char text[32];
  if (gmtime_r(&whole, &parts) == nullptr) return "";
  return {text, std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S", &parts)};
}

}  // namespace adit::icd
