// Lines with libgpiod 1 (Debian 12).
#include <gpiod.h>

#include <array>
#include <cerrno>
#include <utility>

#include "icd/try.hpp"
#include "panel/gpio.hpp"
#include "panel/lines.hpp"

namespace adit::panel {
namespace {

/// errno as libgpiod left it. libgpiod leaves 0 if it did not find the line or chip.
int gpio_error() {
  return errno == 0 ? ENOENT : errno;
}

struct CloseChip {
  void operator()(gpiod_chip* chip) const { gpiod_chip_close(chip); }
};
using Chip = std::unique_ptr<gpiod_chip, CloseChip>;

struct FoundLine {
  Chip chip;  // outlives the line
  gpiod_line* line = nullptr;
};

std::expected<FoundLine, std::string> find(const GpioRequest& wanted) {
  errno = 0;
  if (wanted.chip.empty()) {
    // Opens the chip, which the caller then owns.
    gpiod_line* const line = gpiod_line_find(wanted.line.c_str());
    if (line == nullptr) return panel_error(wanted.about, gpio_error());
    return FoundLine{Chip(gpiod_line_get_chip(line)), line};
  }
  Chip chip(gpiod_chip_open_lookup(wanted.chip.c_str()));
  if (!chip) return panel_error("chip " + wanted.chip, gpio_error());
  errno = 0;
  gpiod_line* const line = gpiod_chip_find_line(chip.get(), wanted.line.c_str());
  if (line == nullptr) return panel_error(wanted.about, gpio_error());
  return FoundLine{std::move(chip), line};
}

class Line final : public GpioLine {
 public:
  explicit Line(FoundLine found) : found_(std::move(found)) {}
  Line(const Line&) = delete;
  Line& operator=(const Line&) = delete;
  ~Line() override { gpiod_line_release(found_.line); }

  int set(bool active) override { return gpiod_line_set_value(found_.line, active ? 1 : 0); }
  int get() override { return gpiod_line_get_value(found_.line); }
  int descriptor() const override { return gpiod_line_event_get_fd(found_.line); }
  int drop_edges() override {
    constexpr timespec kNow{};
    std::array<gpiod_line_event, 16> events{};
    int waiting = 0;
    while ((waiting = gpiod_line_event_wait(found_.line, &kNow)) > 0) {
      if (gpiod_line_event_read_multiple(found_.line, events.data(), events.size()) < 0) return -1;
    }
    return waiting;
  }

 private:
  FoundLine found_;
};

}  // namespace

std::expected<std::unique_ptr<GpioLine>, std::string> request_line(const GpioRequest& wanted) {
  auto found = ADIT_TRY(find(wanted));
  const int level = wanted.active_low ? GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW : 0;
  const int pull =
      wanted.active_low ? GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_UP : GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN;
  const auto request = [&](int flags) {
    const char* const consumer = wanted.consumer.c_str();
    if (wanted.is_output) return gpiod_line_request_output_flags(found.line, consumer, flags, 0) == 0;
    return gpiod_line_request_both_edges_events_flags(found.line, consumer, flags) == 0;
  };
  const bool is_pulled = !wanted.is_output && request(level | pull);
  if (!is_pulled && !request(level)) return panel_error(wanted.about, errno);  // some chips have no pull
  return std::make_unique<Line>(std::move(found));
}

std::string gpiod_version() {
  return gpiod_version_string();
}

}  // namespace adit::panel
