#include "panel/address_digits.hpp"

namespace adit::panel {
namespace {

using namespace std::chrono_literals;

constexpr Milliseconds kDigitFlash = 200ms, kBetween = 300ms, kAfter = 1200ms;  // after a digit or a dot
constexpr Milliseconds kLong = 1000ms, kBefore = 1500ms;                        // before each time

void add_flashes(std::vector<Step>& steps, int count, Milliseconds length) {
  for (int i = 0; i < count; ++i) {
    steps.push_back({true, length});
    steps.push_back({false, i + 1 == count ? kAfter : kBetween});
  }
}

}  // namespace

std::vector<Step> address_digits(std::string_view address) {
  std::vector<Step> steps;
  for (int time = 0; time < 2; ++time) {
    steps.push_back({false, kBefore});
    for (const char c : address) {
      if (c == '.') add_flashes(steps, 1, kLong);
      if (c >= '0' && c <= '9') add_flashes(steps, c == '0' ? 10 : c - '0', kDigitFlash);
    }
  }
  return steps;
}

}  // namespace adit::panel
