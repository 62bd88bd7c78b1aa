#include "panel/fake_gpiod.hpp"

#include <algorithm>
#include <cerrno>
#include <stdexcept>

namespace adit::panel {
namespace {

int fails_with(int error) {
  errno = error;
  return -1;
}

}  // namespace

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

int request(const FakeChip& chip, FakeLine& line, const FakeLine& as) {
  if (line.requested) return fails_with(EBUSY);
  if (as.pull != 0 && !chip.knows_pull) return fails_with(EINVAL);
  line.requested = true;
  line.output = as.output;
  line.active_low = as.active_low;
  line.pull = as.pull;
  line.consumer = as.consumer;
  return 0;
}

int set_value(FakeLine& line, bool active) {
  if (line.fails_with != 0) return fails_with(line.fails_with);
  line.level = active != line.active_low;
  return 0;
}

int get_value(const FakeLine& line) {
  if (line.fails_with != 0) return fails_with(line.fails_with);
  return line.level != line.active_low ? 1 : 0;
}

int read_events(FakeLine& line, std::size_t most) {
  const int read = std::min(line.events, static_cast<int>(most));
  line.events -= read;
  return read;
}

}  // namespace adit::panel
