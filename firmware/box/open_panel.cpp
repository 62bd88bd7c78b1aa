#include "box/open_panel.hpp"

#include <utility>

#include "host/log.hpp"
#include "host/service.hpp"
#include "panel/remote.hpp"

namespace adit::box {
namespace {

constexpr const char* kConsumer = "aditd";

std::unique_ptr<panel::Lines> open_lines(const settings::Panel& settings, const std::string& folder) {
  if (!settings.is_simulated()) {
    auto lines = panel::open_gpio(settings, kConsumer);
    if (lines) return std::move(*lines);
    host::log(host::Level::Error, "the panel is simulated: its lines cannot be had",
              {{"why", lines.error()}});
  }
  return panel::simulated(folder + "/panel");
}

/// A real button that cannot be had is none: what anybody could press in its place is no proof that he is at
/// the box.
std::unique_ptr<panel::ButtonLine> open_button(const settings::Panel& settings, const std::string& folder) {
  if (!settings.is_simulated() && settings.button.empty()) return nullptr;
  auto button = settings.is_simulated() ? panel::simulated_button(folder + "/panel.button")
                                        : panel::open_gpio_button(settings, kConsumer);
  if (button) return std::move(*button);
  host::log(host::Level::Error, "the button cannot be had", {{"why", button.error()}});
  return nullptr;
}

}  // namespace

KnownBoard read_board(const std::string& file) {
  if (file.empty() || !host::may_exist(file)) return {};
  const auto text = host::read_file(file);
  auto board =
      text ? settings::parse_board(*text) : std::unexpected(std::vector<settings::Error>{{"", text.error()}});
  if (board) return {std::move(*board), ""};
  std::string trouble =
      "what the board is cannot be read: " + file + ": " + settings::sentence_of(board.error());
  host::log(host::Level::Error, trouble);
  return {{}, std::move(trouble)};
}

OpenPanel open_panel(const settings::Panel& settings, const PanelPlace& place,
                     loop::FileDescriptor announced) {
  if (!place.socket.empty()) {
    auto held = panel::remote(place.socket, settings, std::move(announced));
    if (held) return {std::move(held->lines), std::move(held->button)};
    host::log(host::Level::Error, "the panel is simulated: adit-panel cannot be had",
              {{"why", held.error()}});
  }
  return {open_lines(settings, place.folder), open_button(settings, place.folder)};
}

}  // namespace adit::box
