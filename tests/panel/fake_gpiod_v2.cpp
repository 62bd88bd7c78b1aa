// The functions of libgpiod 2 that the panel calls; the program's own definitions win over the library's.
#include <gpiod.h>

#include <algorithm>
#include <cerrno>
#include <iterator>
#include <string>

#include "panel/fake_gpiod.hpp"

using adit::panel::fake_gpio;
using adit::panel::FakeChip;
using adit::panel::FakeLine;

struct gpiod_chip {
  FakeChip* state;
};
struct gpiod_chip_info {
  FakeChip* state;
};
struct gpiod_line_settings {
  FakeLine wanted;
  bool lit = false;
};
struct gpiod_line_config {
  unsigned offset = 0;
  gpiod_line_settings settings;
};
struct gpiod_request_config {
  std::string consumer;
};
struct gpiod_line_request {
  std::string name;
  FakeLine* line;
};
struct gpiod_edge_event_buffer {
  std::size_t capacity;
};

extern "C" {

gpiod_chip* gpiod_chip_open(const char* path) {
  const auto chip = fake_gpio().chips.find(path);
  if (chip == fake_gpio().chips.end()) {
    errno = ENOENT;
    return nullptr;
  }
  ++fake_gpio().open;
  return new gpiod_chip{&chip->second};
}

void gpiod_chip_close(gpiod_chip* chip) {
  --fake_gpio().open;
  delete chip;
}

gpiod_chip_info* gpiod_chip_get_info(gpiod_chip* chip) {
  return new gpiod_chip_info{chip->state};
}

void gpiod_chip_info_free(gpiod_chip_info* info) {
  delete info;
}

const char* gpiod_chip_info_get_name(gpiod_chip_info* info) {
  return info->state->name.c_str();
}

const char* gpiod_chip_info_get_label(gpiod_chip_info* info) {
  return info->state->label.c_str();
}

bool gpiod_is_gpiochip_device(const char* path) {
  return fake_gpio().chips.contains(path);
}

int gpiod_chip_get_line_offset_from_name(gpiod_chip* chip, const char* name) {
  const auto line = chip->state->lines.find(name);
  if (line == chip->state->lines.end()) {
    errno = ENOENT;
    return -1;
  }
  return static_cast<int>(std::distance(chip->state->lines.begin(), line));
}

gpiod_line_settings* gpiod_line_settings_new() {
  return new gpiod_line_settings{};
}

void gpiod_line_settings_free(gpiod_line_settings* settings) {
  delete settings;
}

int gpiod_line_settings_set_direction(gpiod_line_settings* settings, gpiod_line_direction direction) {
  settings->wanted.output = direction == GPIOD_LINE_DIRECTION_OUTPUT;
  return 0;
}

int gpiod_line_settings_set_edge_detection(gpiod_line_settings*, gpiod_line_edge) {
  return 0;
}

int gpiod_line_settings_set_bias(gpiod_line_settings* settings, gpiod_line_bias bias) {
  settings->wanted.pull = bias == GPIOD_LINE_BIAS_PULL_UP ? 1 : bias == GPIOD_LINE_BIAS_PULL_DOWN ? -1 : 0;
  return 0;
}

void gpiod_line_settings_set_active_low(gpiod_line_settings* settings, bool active_low) {
  settings->wanted.active_low = active_low;
}

int gpiod_line_settings_set_output_value(gpiod_line_settings* settings, gpiod_line_value value) {
  settings->lit = value == GPIOD_LINE_VALUE_ACTIVE;
  return 0;
}

gpiod_line_config* gpiod_line_config_new() {
  return new gpiod_line_config{};
}

void gpiod_line_config_free(gpiod_line_config* config) {
  delete config;
}

int gpiod_line_config_add_line_settings(gpiod_line_config* config, const unsigned int* offsets, size_t,
                                        gpiod_line_settings* settings) {
  config->offset = *offsets;
  config->settings = *settings;
  return 0;
}

gpiod_request_config* gpiod_request_config_new() {
  return new gpiod_request_config{};
}

void gpiod_request_config_free(gpiod_request_config* config) {
  delete config;
}

void gpiod_request_config_set_consumer(gpiod_request_config* config, const char* consumer) {
  config->consumer = consumer;
}

gpiod_line_request* gpiod_chip_request_lines(gpiod_chip* chip, gpiod_request_config* config,
                                             gpiod_line_config* lines) {
  auto& [name, line] = *std::next(chip->state->lines.begin(), lines->offset);
  const FakeLine& wanted = lines->settings.wanted;
  if (line.requested || (wanted.pull != 0 && !chip->state->knows_pull)) {
    errno = line.requested ? EBUSY : EINVAL;
    return nullptr;
  }
  line.requested = true;
  line.output = wanted.output;
  line.active_low = wanted.active_low;
  line.pull = wanted.pull;
  line.consumer = config->consumer;
  if (wanted.output) line.level = lines->settings.lit != wanted.active_low;
  ++fake_gpio().open;
  fake_gpio().history.push_back("request " + name);
  return new gpiod_line_request{name, &line};
}

void gpiod_line_request_release(gpiod_line_request* request) {
  request->line->requested = false;
  --fake_gpio().open;
  fake_gpio().history.push_back("release " + request->name);
  delete request;
}

int gpiod_line_request_set_value(gpiod_line_request* request, unsigned int, gpiod_line_value value) {
  if (request->line->fails_with != 0) {
    errno = request->line->fails_with;
    return -1;
  }
  request->line->level = (value == GPIOD_LINE_VALUE_ACTIVE) != request->line->active_low;
  return 0;
}

gpiod_line_value gpiod_line_request_get_value(gpiod_line_request* request, unsigned int) {
  if (request->line->fails_with != 0) {
    errno = request->line->fails_with;
    return GPIOD_LINE_VALUE_ERROR;
  }
  return request->line->level != request->line->active_low ? GPIOD_LINE_VALUE_ACTIVE
                                                           : GPIOD_LINE_VALUE_INACTIVE;
}

int gpiod_line_request_get_fd(gpiod_line_request* request) {
  return request->line->descriptor;
}

int gpiod_line_request_wait_edge_events(gpiod_line_request* request, int64_t) {
  return request->line->events > 0 ? 1 : 0;
}

int gpiod_line_request_read_edge_events(gpiod_line_request* request, gpiod_edge_event_buffer* buffer,
                                        size_t most) {
  const int read = std::min(request->line->events, static_cast<int>(std::min(most, buffer->capacity)));
  request->line->events -= read;
  return read;
}

gpiod_edge_event_buffer* gpiod_edge_event_buffer_new(size_t capacity) {
  return new gpiod_edge_event_buffer{capacity};
}

void gpiod_edge_event_buffer_free(gpiod_edge_event_buffer* buffer) {
  delete buffer;
}

}  // extern "C"
