// The functions of libgpiod 1 that the panel calls. The program's definitions replace the library's.
#include <gpiod.h>

#include <cerrno>

#include "panel/fake_gpiod.hpp"

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
  if (chip.opens_with != 0) {
    errno = chip.opens_with;
    return nullptr;
  }
  ++fake_gpio().open;
  return new gpiod_chip{&chip};
}

int request(gpiod_line* line, const char* consumer, int flags, bool output) {
  return adit::panel::request(*line->chip->state, *line->state,
                              {.output = output,
                               .active_low = (flags & GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW) != 0,
                               .pull = (flags & GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_UP) != 0     ? 1
                                       : (flags & GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN) != 0 ? -1
                                                                                               : 0,
                               .consumer = consumer});
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
    if (chip.opens_with == 0 && !chip.lines.contains(name)) continue;
    gpiod_chip* const found = opened(chip);
    return found == nullptr ? nullptr : gpiod_chip_find_line(found, name);
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
  return set_value(*line->state, value != 0);
}

int gpiod_line_get_value(gpiod_line* line) {
  return get_value(*line->state);
}

int gpiod_line_event_get_fd(gpiod_line* line) {
  return line->state->descriptor;
}

int gpiod_line_event_wait(gpiod_line* line, const timespec*) {
  return line->state->events > 0 ? 1 : 0;
}

int gpiod_line_event_read_multiple(gpiod_line* line, gpiod_line_event*, unsigned int most) {
  return read_events(*line->state, most);
}

void gpiod_line_release(gpiod_line* line) {
  line->state->requested = false;
}

}  // extern "C"
