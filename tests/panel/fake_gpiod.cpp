// The functions of libgpiod 1 that the panel calls; the program's own definitions win over the library's.
#include "panel/fake_gpiod.hpp"

#include <gpiod.h>

#include <algorithm>
#include <cerrno>
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

using adit::panel::fake_gpio;
using adit::panel::FakeChip;
using adit::panel::FakeLine;

struct gpiod_chip {
  FakeChip* state;
};
struct gpiod_line {
  std::string name;
  FakeLine* state;
  gpiod_chip* chip;
};

namespace {

gpiod_chip* opened(FakeChip& chip) {
  ++fake_gpio().open;
  return new gpiod_chip{&chip};
}

int request(gpiod_line* line, const char* consumer, int flags, bool output) {
  const bool pull =
      (flags & (GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_UP | GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN)) != 0;
  if (line->state->requested || (pull && !line->chip->state->knows_pull)) {
    errno = line->state->requested ? EBUSY : EINVAL;
    return -1;
  }
  *line->state = {.requested = true,
                  .output = output,
                  .active_low = (flags & GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW) != 0,
                  .pull = (flags & GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_UP) != 0     ? 1
                          : (flags & GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN) != 0 ? -1
                                                                                  : 0,
                  .consumer = consumer,
                  .level = line->state->level,
                  .fails_with = line->state->fails_with,
                  .descriptor = line->state->descriptor,
                  .events = line->state->events};
  return 0;
}

std::map<std::string, gpiod_line> the_lines;

}  // namespace

extern "C" {

gpiod_chip* gpiod_chip_open_lookup(const char* name) {
  for (auto& [path, chip] : fake_gpio().chips) {
    if (name == path || name == chip.name || name == chip.label) return opened(chip);
  }
  errno = ENOENT;
  return nullptr;
}

void gpiod_chip_close(gpiod_chip* chip) {
  --fake_gpio().open;
  delete chip;
}

gpiod_line* gpiod_chip_find_line(gpiod_chip* chip, const char* name) {
  const auto line = chip->state->lines.find(name);
  if (line == chip->state->lines.end()) {
    errno = ENOENT;
    return nullptr;
  }
  return &(the_lines[name] = {name, &line->second, chip});
}

gpiod_line* gpiod_line_find(const char* name) {
  for (auto& [path, chip] : fake_gpio().chips) {
    if (!chip.lines.contains(name)) continue;
    return gpiod_chip_find_line(opened(chip), name);
  }
  errno = ENOENT;
  return nullptr;
}

gpiod_chip* gpiod_line_get_chip(gpiod_line* line) {
  return line->chip;
}

int gpiod_line_request_output_flags(gpiod_line* line, const char* consumer, int flags, int value) {
  if (request(line, consumer, flags, true) != 0) return -1;
  line->state->level = (value != 0) != line->state->active_low;
  return 0;
}

int gpiod_line_request_both_edges_events_flags(gpiod_line* line, const char* consumer, int flags) {
  return request(line, consumer, flags, false);
}

int gpiod_line_set_value(gpiod_line* line, int value) {
  if (line->state->fails_with != 0) {
    errno = line->state->fails_with;
    return -1;
  }
  line->state->level = (value != 0) != line->state->active_low;
  return 0;
}

int gpiod_line_get_value(gpiod_line* line) {
  if (line->state->fails_with != 0) {
    errno = line->state->fails_with;
    return -1;
  }
  return line->state->level != line->state->active_low ? 1 : 0;
}

int gpiod_line_event_get_fd(gpiod_line* line) {
  return line->state->descriptor;
}

int gpiod_line_event_wait(gpiod_line* line, const timespec*) {
  return line->state->events > 0 ? 1 : 0;
}

int gpiod_line_event_read_multiple(gpiod_line* line, gpiod_line_event*, unsigned int most) {
  const int read = std::min(line->state->events, static_cast<int>(most));
  line->state->events -= read;
  return read;
}

void gpiod_line_release(gpiod_line* line) {
  line->state->requested = false;
}

}  // extern "C"
