#include "panel/fake_gpiod.hpp"

#include <gpiod.h>

#include <cerrno>

// The functions of libgpiod that the panel calls; the program's own definitions win over the library's.
struct gpiod_chip {
  adit::panel::FakeChip state;
};
struct gpiod_line {
  std::string name;
  adit::panel::FakeLine* state;
};

namespace {
gpiod_chip the_chip;
std::map<std::string, gpiod_line> the_lines;
}  // namespace

namespace adit::panel {
FakeChip& fake_chip() {
  return the_chip.state;
}
}  // namespace adit::panel

extern "C" {

gpiod_chip* gpiod_chip_open_lookup(const char* name) {
  if (std::string(name) != "gpiochip0") {
    errno = ENOENT;
    return nullptr;
  }
  ++the_chip.state.open;
  the_chip.state.history.emplace_back("open");
  return &the_chip;
}

void gpiod_chip_close(gpiod_chip* chip) {
  --chip->state.open;
  chip->state.history.emplace_back("close");
}

gpiod_line* gpiod_chip_find_line(gpiod_chip* chip, const char* name) {
  const auto line = chip->state.lines.find(name);
  if (line == chip->state.lines.end()) {
    errno = ENOENT;
    return nullptr;
  }
  return &(the_lines[name] = {name, &line->second});
}

int gpiod_line_request_output_flags(gpiod_line* line, const char* consumer, int flags, int value) {
  if (line->state->requested) {
    errno = EBUSY;
    return -1;
  }
  line->state->requested = true;
  line->state->consumer = consumer;
  line->state->active_low = (flags & GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW) != 0;
  line->state->level = (value != 0) != line->state->active_low;
  the_chip.state.history.push_back("request " + line->name);
  return 0;
}

int gpiod_line_set_value(gpiod_line* line, int value) {
  if (line->state->fails_with != 0) {
    errno = line->state->fails_with;
    return -1;
  }
  line->state->level = (value != 0) != line->state->active_low;
  return 0;
}

void gpiod_line_release(gpiod_line* line) {
  line->state->requested = false;
  the_chip.state.history.push_back("release " + line->name);
}

}  // extern "C"
