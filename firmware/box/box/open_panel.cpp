#include "box/open_panel.hpp"

#include <utility>

#include "host/log.hpp"
#include "host/service.hpp"
#include "panel/remote.hpp"

namespace adit::box {
namespace {

constexpr const char* kConsumer = "aditd";

}  // namespace

KnownBoard read_board(const std::string& file) {
  if (file.empty() || !host::may_exist(file)) return {};
  const auto text = host::read_file(file);
  auto board =
      text ? settings::parse_board(*text) : std::unexpected(std::vector<settings::Error>{{"", text.error()}});
  if (board) return {std::move(*board), ""};
  std::string trouble =
      "cannot read the board's description: " + file + ": " + settings::sentence_of(board.error());
  host::log(host::Level::Error, trouble);
  return {{}, std::move(trouble)};
}

panel::Held open_panel(const settings::Panel& settings, const PanelPlace& place,
                       loop::FileDescriptor announced) {
  if (!place.socket.empty()) {
    auto held = panel::remote(place.socket, settings, std::move(announced));
    if (held) return std::move(*held);
    host::log(host::Level::Error, "cannot use adit-panel: the panel is simulated", {{"why", held.error()}});
  }
  return panel::hold(settings, kConsumer, place.folder + "/panel",
                     [](const std::string& sentence) { host::log(host::Level::Error, sentence); });
}

}  // namespace adit::box
