// The functions of libgpiod 2 that the panel calls, and glob(3) for the fake's chips. The program's
// definitions replace the library's.
#include <glob.h>
#include <gpiod.h>

#include <cerrno>
#include <cstdint>
#include <iterator>
#include <vector>

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
  FakeLine line;
  gpiod_line_edge edges;
};
struct gpiod_line_config {
  unsigned offset;
  gpiod_line_settings settings;
};
struct gpiod_request_config {
  std::string consumer;
};
struct gpiod_line_request {
  FakeLine* state;
  unsigned offset;
};
struct gpiod_edge_event_buffer {
  std::size_t most;
};

namespace {

int invalid() {
  errno = EINVAL;
  return -1;
}

}  // namespace

extern "C" {

int glob(const char* pattern, int, int (*)(const char*, int), glob_t* found) {
  static std::vector<char*> paths;
  paths.clear();
  errno = fake_gpio().lists_with;
  if (errno != 0) return GLOB_ABORTED;
  for (const auto& [path, chip] : fake_gpio().chips) paths.push_back(const_cast<char*>(path.c_str()));
  if (paths.empty() || pattern != std::string("/dev/gpiochip*")) return GLOB_NOMATCH;
  found->gl_pathv = paths.data();
  found->gl_pathc = paths.size();
  return 0;
}

void globfree(glob_t*) {}

gpiod_chip* gpiod_chip_open(const char* path) {
  const auto found = fake_gpio().chips.find(path);
  errno = found == fake_gpio().chips.end() ? ENOENT : found->second.opens_with;
  if (errno != 0) return nullptr;
  ++fake_gpio().open;
  return new gpiod_chip{&found->second};
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

int gpiod_chip_get_line_offset_from_name(gpiod_chip* chip, const char* name) {
  const auto& lines = chip->state->lines;
  const auto found = lines.find(name);
  if (found != lines.end()) return static_cast<int>(std::distance(lines.begin(), found));
  errno = ENOENT;
  return -1;
}

gpiod_line_settings* gpiod_line_settings_new() {
  return new gpiod_line_settings{};
}

void gpiod_line_settings_free(gpiod_line_settings* settings) {
  delete settings;
}

int gpiod_line_settings_set_direction(gpiod_line_settings* settings, gpiod_line_direction direction) {
  settings->line.output = direction == GPIOD_LINE_DIRECTION_OUTPUT;
  return 0;
}

int gpiod_line_settings_set_edge_detection(gpiod_line_settings* settings, gpiod_line_edge edges) {
  settings->edges = edges;
  return 0;
}

int gpiod_line_settings_set_bias(gpiod_line_settings* settings, gpiod_line_bias bias) {
  settings->line.pull = bias == GPIOD_LINE_BIAS_PULL_UP ? 1 : bias == GPIOD_LINE_BIAS_PULL_DOWN ? -1 : 0;
  return 0;
}

void gpiod_line_settings_set_active_low(gpiod_line_settings* settings, bool active_low) {
  settings->line.active_low = active_low;
}

gpiod_line_config* gpiod_line_config_new() {
  return new gpiod_line_config{};
}

void gpiod_line_config_free(gpiod_line_config* config) {
  delete config;
}

int gpiod_line_config_add_line_settings(gpiod_line_config* config, const unsigned* offsets, std::size_t count,
                                        gpiod_line_settings* settings) {
  if (count != 1) return invalid();
  *config = {.offset = *offsets, .settings = *settings};
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
  FakeLine& line = std::next(chip->state->lines.begin(), lines->offset)->second;
  FakeLine as = lines->settings.line;
  as.consumer = config->consumer;
  if (as.output ==
      (lines->settings.edges == GPIOD_LINE_EDGE_BOTH)) {  // a button needs edges, an output has none
    invalid();
    return nullptr;
  }
  if (request(*chip->state, line, as) != 0) return nullptr;
  if (line.output) line.level = line.active_low;
  ++fake_gpio().open;
  return new gpiod_line_request{.state = &line, .offset = lines->offset};
}

void gpiod_line_request_release(gpiod_line_request* request) {
  request->state->requested = false;
  --fake_gpio().open;
  delete request;
}

int gpiod_line_request_set_value(gpiod_line_request* request, unsigned offset, gpiod_line_value value) {
  if (offset != request->offset) return invalid();
  return set_value(*request->state, value == GPIOD_LINE_VALUE_ACTIVE);
}

gpiod_line_value gpiod_line_request_get_value(gpiod_line_request* request, unsigned offset) {
  return static_cast<gpiod_line_value>(offset == request->offset ? get_value(*request->state) : invalid());
}

int gpiod_line_request_get_fd(gpiod_line_request* request) {
  return request->state->descriptor;
}

int gpiod_line_request_wait_edge_events(gpiod_line_request* request, std::int64_t) {
  return request->state->events > 0 ? 1 : 0;
}

int gpiod_line_request_read_edge_events(gpiod_line_request* request, gpiod_edge_event_buffer* buffer,
                                        std::size_t most) {
  return most <= buffer->most ? read_events(*request->state, most) : invalid();
}

gpiod_edge_event_buffer* gpiod_edge_event_buffer_new(std::size_t capacity) {
  return new gpiod_edge_event_buffer{.most = capacity};
}

void gpiod_edge_event_buffer_free(gpiod_edge_event_buffer* buffer) {
  delete buffer;
}

}  // extern "C"
