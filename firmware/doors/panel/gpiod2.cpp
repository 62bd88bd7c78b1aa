// Lines with libgpiod 2 (Debian 13).
#include <glob.h>
#include <gpiod.h>

#include <cerrno>
#include <utility>
#include <vector>

#include "icd/try.hpp"
#include "panel/gpio.hpp"
#include "panel/lines.hpp"

namespace adit::panel {
namespace {

template <auto Free>
struct Deleter {
  void operator()(auto* object) const { Free(object); }
};
template <typename Object, auto Free>
using Owned = std::unique_ptr<Object, Deleter<Free>>;
using Chip = Owned<gpiod_chip, gpiod_chip_close>;
using Request = Owned<gpiod_line_request, gpiod_line_request_release>;

struct FoundLine {
  Chip chip;
  unsigned offset = 0;
};

/// `about` begins an error.
std::expected<std::vector<std::string>, std::string> chip_paths(const std::string& about) {
  glob_t found{};
  const int failed = glob("/dev/gpiochip*", GLOB_ERR, nullptr, &found);
  std::vector<std::string> paths(found.gl_pathv, found.gl_pathv + found.gl_pathc);
  globfree(&found);
  if (failed != 0 && failed != GLOB_NOMATCH) return panel_error(about + ": /dev", errno);
  return paths;
}

/// A chip that cannot be read is an error only if the line is not found on another chip.
std::expected<FoundLine, std::string> find(const GpioRequest& wanted) {
  const bool is_any = wanted.chip.empty(), is_path = wanted.chip.starts_with('/');
  const std::string about = is_any ? wanted.about : "chip " + wanted.chip;
  const auto paths = is_path ? std::vector{wanted.chip} : ADIT_TRY(chip_paths(about));
  auto failure = panel_error(about, ENOENT);
  for (const std::string& path : paths) {
    Chip chip(gpiod_chip_open(path.c_str()));
    const Owned<gpiod_chip_info, gpiod_chip_info_free> info(chip ? gpiod_chip_get_info(chip.get()) : nullptr);
    if (!info) {
      failure = panel_error(is_path ? about : about + ": " + path, errno);
      continue;
    }
    const bool is_named = is_path || wanted.chip == gpiod_chip_info_get_name(info.get()) ||
                          wanted.chip == gpiod_chip_info_get_label(info.get());
    if (!is_named && !is_any) continue;
    const int offset = gpiod_chip_get_line_offset_from_name(chip.get(), wanted.line.c_str());
    if (offset >= 0) return FoundLine{std::move(chip), static_cast<unsigned>(offset)};
    if (!is_any) return panel_error(wanted.about, errno);
    if (errno != ENOENT) failure = panel_error(about + ": " + path, errno);
  }
  return failure;
}

/// Sets errno and returns null if it fails.
Request request(const FoundLine& found, const GpioRequest& wanted, gpiod_line_bias bias) {
  const Owned<gpiod_line_settings, gpiod_line_settings_free> settings(gpiod_line_settings_new());
  const Owned<gpiod_line_config, gpiod_line_config_free> lines(gpiod_line_config_new());
  const Owned<gpiod_request_config, gpiod_request_config_free> options(gpiod_request_config_new());
  if (!settings || !lines || !options) return {};
  gpiod_line_settings_set_direction(
      settings.get(), wanted.is_output ? GPIOD_LINE_DIRECTION_OUTPUT : GPIOD_LINE_DIRECTION_INPUT);
  if (!wanted.is_output) gpiod_line_settings_set_edge_detection(settings.get(), GPIOD_LINE_EDGE_BOTH);
  gpiod_line_settings_set_bias(settings.get(), bias);
  gpiod_line_settings_set_active_low(settings.get(), wanted.active_low);
  gpiod_request_config_set_consumer(options.get(), wanted.consumer.c_str());
  if (gpiod_line_config_add_line_settings(lines.get(), &found.offset, 1, settings.get()) != 0) return {};
  return Request(gpiod_chip_request_lines(found.chip.get(), options.get(), lines.get()));
}

class Line final : public GpioLine {
 public:
  Line(Request request, unsigned offset) : request_(std::move(request)), offset_(offset) {}

  int set(bool active) override {
    return gpiod_line_request_set_value(request_.get(), offset_,
                                        active ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE);
  }
  int get() override { return gpiod_line_request_get_value(request_.get(), offset_); }
  int descriptor() const override { return gpiod_line_request_get_fd(request_.get()); }
  int drop_edges() override {
    const Owned<gpiod_edge_event_buffer, gpiod_edge_event_buffer_free> events(
        gpiod_edge_event_buffer_new(16));
    int waiting = events ? 0 : -1;
    while (events && (waiting = gpiod_line_request_wait_edge_events(request_.get(), 0)) > 0) {
      if (gpiod_line_request_read_edge_events(request_.get(), events.get(), 16) < 0) return -1;
    }
    return waiting;
  }

 private:
  Request request_;
  unsigned offset_;
};

}  // namespace

std::expected<std::unique_ptr<GpioLine>, std::string> request_line(const GpioRequest& wanted) {
  const auto found = ADIT_TRY(find(wanted));
  Request line;
  if (!wanted.is_output) {
    line = request(found, wanted, wanted.active_low ? GPIOD_LINE_BIAS_PULL_UP : GPIOD_LINE_BIAS_PULL_DOWN);
  }
  if (!line) line = request(found, wanted, GPIOD_LINE_BIAS_AS_IS);  // some chips have no pull
  if (!line) return panel_error(wanted.about, errno);
  return std::make_unique<Line>(std::move(line), found.offset);
}

std::string gpiod_version() {
  return gpiod_api_version();
}

}  // namespace adit::panel
