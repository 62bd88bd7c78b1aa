// The panel by libgpiod 2.
#include <gpiod.h>

#include <utility>
#include <vector>

#include "panel/gpio_lines.hpp"

namespace adit::panel {
namespace {

template <auto free>
struct Free {
  template <class T>
  void operator()(T* object) const {
    free(object);
  }
};
using Chip = std::unique_ptr<gpiod_chip, Free<gpiod_chip_close>>;
using ChipInfo = std::unique_ptr<gpiod_chip_info, Free<gpiod_chip_info_free>>;
using LineSettings = std::unique_ptr<gpiod_line_settings, Free<gpiod_line_settings_free>>;
using LineConfig = std::unique_ptr<gpiod_line_config, Free<gpiod_line_config_free>>;
using RequestConfig = std::unique_ptr<gpiod_request_config, Free<gpiod_request_config_free>>;
using Request = std::unique_ptr<gpiod_line_request, Free<gpiod_line_request_release>>;
using Events = std::unique_ptr<gpiod_edge_event_buffer, Free<gpiod_edge_event_buffer_free>>;

/// Whether it is the one that is meant: by the kernel's name for it, by its label, or any.
bool is_called(gpiod_chip* chip, const std::string& name) {
  if (name.empty()) return true;
  const ChipInfo info(gpiod_chip_get_info(chip));
  return info &&
         (name == gpiod_chip_info_get_name(info.get()) || name == gpiod_chip_info_get_label(info.get()));
}

/// The devices of all chips in the order of their numbers, or the one whose path this is.
std::vector<std::string> devices(const std::string& chip) {
  constexpr int kMost = 64;  // numbers; there may be gaps
  if (chip.starts_with('/')) return {chip};
  std::vector<std::string> paths;
  for (int number = 0; number < kMost; ++number) {
    std::string path = "/dev/gpiochip" + std::to_string(number);
    if (gpiod_is_gpiochip_device(path.c_str())) paths.push_back(std::move(path));
  }
  return paths;
}

struct Found {
  Chip chip;
  unsigned offset = 0;
};

/// `about` is for the error.
std::expected<Found, std::string> find(const settings::Panel& settings, const std::string& line,
                                       const std::string& about) {
  int error = ENOENT;
  bool seen = settings.chip.empty();
  for (const std::string& path : devices(settings.chip)) {
    Chip chip(gpiod_chip_open(path.c_str()));
    if (!chip) {
      error = errno;
      continue;
    }
    if (path != settings.chip && !is_called(chip.get(), settings.chip)) continue;
    seen = true;
    errno = 0;
    const int offset = gpiod_chip_get_line_offset_from_name(chip.get(), line.c_str());
    if (offset >= 0) return Found{std::move(chip), static_cast<unsigned>(offset)};
    error = gpio_error();
  }
  return gpio_trouble(seen ? about : "chip " + settings.chip, error);
}

/// Null, with errno: it cannot be had.
Request request(const Found& found, gpiod_line_settings* line_settings, const std::string& consumer) {
  const LineConfig lines(gpiod_line_config_new());
  const RequestConfig config(gpiod_request_config_new());
  if (line_settings == nullptr || !lines || !config) return nullptr;
  gpiod_request_config_set_consumer(config.get(), consumer.c_str());
  if (gpiod_line_config_add_line_settings(lines.get(), &found.offset, 1, line_settings) != 0) return nullptr;
  return Request(gpiod_chip_request_lines(found.chip.get(), config.get(), lines.get()));
}

/// An output, dark at first and when it is let go. It needs its chip no longer.
class Output {
 public:
  Output() = default;
  Output(Request request, unsigned offset) : request_(std::move(request)), offset_(offset) {}
  Output(Output&&) noexcept = default;
  Output& operator=(Output&& other) noexcept {
    std::swap(request_, other.request_);
    std::swap(offset_, other.offset_);
    return *this;
  }
  ~Output() {
    if (request_) set(false);
  }
  bool is_there() const { return request_ != nullptr; }
  bool set(bool lit) {
    const auto value = lit ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE;
    return gpiod_line_request_set_value(request_.get(), offset_, value) == 0;
  }

 private:
  Request request_;
  unsigned offset_ = 0;
};

/// `about` is for the error.
std::expected<Output, std::string> request_output(const settings::Panel& settings, const std::string& line,
                                                  const std::string& about, const std::string& consumer) {
  const auto found = find(settings, line, about);
  if (!found) return std::unexpected(found.error());
  const LineSettings output(gpiod_line_settings_new());
  if (output) {
    gpiod_line_settings_set_direction(output.get(), GPIOD_LINE_DIRECTION_OUTPUT);
    gpiod_line_settings_set_output_value(output.get(), GPIOD_LINE_VALUE_INACTIVE);
    gpiod_line_settings_set_active_low(output.get(), settings.active_low);
  }
  Request request = panel::request(found.value(), output.get(), consumer);
  if (!request) return gpio_trouble(about, errno);
  return Output(std::move(request), found->offset);
}

class GpioButton final : public ButtonLine {
 public:
  static constexpr std::size_t kMost = 16;  // events read at once

  GpioButton(Request request, unsigned offset, Events events, std::string about)
      : request_(std::move(request)), offset_(offset), events_(std::move(events)), about_(std::move(about)) {}

  int descriptor() const override { return gpiod_line_request_get_fd(request_.get()); }

  /// By its level, not by the events: the kernel drops those of a long bounce.
  std::expected<bool, std::string> pressed() override {
    int waiting = 0;
    while ((waiting = gpiod_line_request_wait_edge_events(request_.get(), 0)) > 0) {
      if (gpiod_line_request_read_edge_events(request_.get(), events_.get(), kMost) < 0) {
        return gpio_trouble(about_, errno);
      }
    }
    const auto value =
        waiting < 0 ? GPIOD_LINE_VALUE_ERROR : gpiod_line_request_get_value(request_.get(), offset_);
    if (value == GPIOD_LINE_VALUE_ERROR) return gpio_trouble(about_, errno);
    return value == GPIOD_LINE_VALUE_ACTIVE;
  }

 private:
  Request request_;
  unsigned offset_;
  Events events_;
  std::string about_;
};

}  // namespace

std::expected<std::unique_ptr<Lines>, std::string> open_gpio(const settings::Panel& settings,
                                                             const std::string& consumer) {
  return open_lines<Output>(settings, [&](const std::string& line, const std::string& about) {
    return request_output(settings, line, about, consumer);
  });
}

std::expected<std::unique_ptr<ButtonLine>, std::string> open_gpio_button(const settings::Panel& settings,
                                                                         const std::string& consumer) {
  const std::string what = about(settings, settings.button, "button");
  const auto found = find(settings, settings.button, what);
  if (!found) return std::unexpected(found.error());
  const LineSettings input(gpiod_line_settings_new());
  if (input) {
    const bool low = settings.button_active_low;
    gpiod_line_settings_set_direction(input.get(), GPIOD_LINE_DIRECTION_INPUT);
    gpiod_line_settings_set_edge_detection(input.get(), GPIOD_LINE_EDGE_BOTH);
    gpiod_line_settings_set_active_low(input.get(), low);
    gpiod_line_settings_set_bias(input.get(), low ? GPIOD_LINE_BIAS_PULL_UP : GPIOD_LINE_BIAS_PULL_DOWN);
  }
  Request line = request(*found, input.get(), consumer);
  if (!line && input) {  // some chips know no pull
    gpiod_line_settings_set_bias(input.get(), GPIOD_LINE_BIAS_AS_IS);
    line = request(*found, input.get(), consumer);
  }
  if (!line) return gpio_trouble(what, errno);
  Events events(gpiod_edge_event_buffer_new(GpioButton::kMost));
  if (!events) return gpio_trouble(what, errno);
  return std::make_unique<GpioButton>(std::move(line), found->offset, std::move(events), what);
}

std::string gpiod_version() {
  return gpiod_api_version();
}

}  // namespace adit::panel
