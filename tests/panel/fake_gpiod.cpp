#include "panel/fake_gpiod.hpp"

#include <unistd.h>

#include <array>
#include <cstdlib>
#include <stdexcept>

namespace adit::panel {

FakeGpio& fake_gpio() {
  static FakeGpio gpio;
  return gpio;
}

FakeLine& FakeGpio::line(const std::string& name) {
  for (auto& [path, chip] : chips) {
    if (const auto found = chip.lines.find(name); found != chip.lines.end()) return found->second;
  }
  throw std::out_of_range(name);
}

void FakeGpio::drive(const std::string& name, bool level) {
  FakeLine& wire = line(name);
  wire.level = level;
  ++wire.events;
}

}  // namespace adit::panel
