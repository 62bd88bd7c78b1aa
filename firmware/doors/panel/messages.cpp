#include "panel/messages.hpp"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <iterator>
#include <optional>

#include "codec/write.hpp"
#include "settings/board.hpp"

namespace adit::panel {
namespace {

constexpr int kWaiting = 4;  // connections not yet accepted
constexpr int kKind = SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC;

/// std::nullopt, with errno: `path` is too long.
std::optional<sockaddr_un> address_of(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof(address.sun_path)) {
    errno = ENAMETOOLONG;
    return std::nullopt;
  }
  std::ranges::copy(path, std::begin(address.sun_path));
  return address;
}

/// The address type of the C interface.
const sockaddr* plain(const sockaddr_un& address) {
  return reinterpret_cast<const sockaddr*>(&address);  // NOLINT(cppcoreguidelines-pro-type-reinterpret-cast)
}

}  // namespace

loop::FileDescriptor connected_to(const std::string& path) {
  const auto address = address_of(path);
  loop::FileDescriptor fd(address ? socket(AF_UNIX, kKind, 0) : -1);
  if (!fd || connect(fd.get(), plain(*address), sizeof(*address)) != 0) return {};
  return fd;
}

loop::FileDescriptor listening_at(const std::string& path) {
  const auto address = address_of(path);
  if (!address || (unlink(path.c_str()) != 0 && errno != ENOENT)) return {};
  loop::FileDescriptor fd(socket(AF_UNIX, kKind, 0));
  if (!fd || fchmod(fd.get(), S_IRUSR | S_IWUSR) != 0 ||
      bind(fd.get(), plain(*address), sizeof(*address)) != 0 || listen(fd.get(), kWaiting) != 0) {
    return {};
  }
  return fd;
}

loop::FileDescriptor accepted_at(const loop::FileDescriptor& listening) {
  return loop::FileDescriptor(accept4(listening.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
}

namespace {

constexpr std::string_view kLit = "lit ", kEnd = "end", kPanel = "panel ", kPressed = "button 1",
                           kLetGo = "button 0", kGone = "button gone", kWell = "lights 1",
                           kTrouble = "lights 0 ";

bool is_printable(char c) {
  return c >= ' ' && c <= '~';
}

std::string member(std::string_view name, const std::string& text) {
  return codec::json_string(name) + ':' + codec::json_string(text);
}

std::string member(std::string_view name, bool is) {
  return codec::json_string(name) + (is ? ":true" : ":false");
}

std::expected<Message, std::string> parse_lit(std::string_view bits) {
  LightRequest message;
  if (bits.size() != kLights.size()) return std::unexpected("lit: expected a digit for each light");
  for (const Light light : kLights) {
    const char bit = bits[index_of(light)];
    if (bit != '0' && bit != '1') return std::unexpected("lit: expected 0 or 1 for each light");
    message.lit[index_of(light)] = bit == '1';
  }
  return message;
}

std::expected<Message, std::string> parse_panel(std::string_view json) {
  auto board = settings::parse_board(json);
  if (!board) return std::unexpected("panel: " + settings::sentence_of(board.error()));
  if (!board->panel) return std::unexpected("panel: missing");
  return LinesRequest{std::move(*board->panel)};
}

}  // namespace

std::string message_of(const LightRequest& message) {
  std::string text(kLit);
  for (const bool lit : message.lit) text.push_back(lit ? '1' : '0');
  return text;
}

std::string message_of(const EndRequest&) {
  return std::string(kEnd);
}

std::string message_of(const LinesRequest& message) {
  const settings::Panel& panel = message.panel;
  std::string json = R"({"name":"settings","title":"settings","panel":{)";
  json += member("chip", panel.chip) + ',' + member("health", panel.health) + ',';
  json += member("scoring", panel.scoring) + ',' + member("mapping", panel.mapping) + ',';
  json += member("attention", panel.attention) + ',' + member("button", panel.button) + ',';
  json += member("active_low", panel.active_low) + ',' + member("button_active_low", panel.button_active_low);
  return std::string(kPanel) + json + "}}";
}

std::expected<Message, std::string> parse_message(std::string_view text) {
  if (text == kEnd) return EndRequest{};
  if (text.starts_with(kLit)) return parse_lit(text.substr(kLit.size()));
  if (text.size() > kLongestMessage) return std::unexpected("the message is too long");
  if (text.starts_with(kPanel)) return parse_panel(text.substr(kPanel.size()));
  return std::unexpected("unknown message");
}

std::string message_of(const ButtonState& said) {
  if (!said.pressed) return std::string(kGone);
  return std::string(*said.pressed ? kPressed : kLetGo);
}

std::string message_of(const LightsState& said) {
  if (said.trouble.empty()) return std::string(kWell);
  std::string why = said.trouble.substr(0, LightsState::kLongest);
  std::ranges::replace_if(why, [](char c) { return !is_printable(c); }, '?');
  return std::string(kTrouble) + why;
}

std::optional<PanelReport> parse_report(std::string_view text) {
  if (text == kPressed) return ButtonState{true};
  if (text == kLetGo) return ButtonState{false};
  if (text == kGone) return ButtonState{};
  if (text == kWell) return LightsState{};
  if (!text.starts_with(kTrouble)) return std::nullopt;
  const std::string_view why = text.substr(kTrouble.size());
  if (why.empty() || why.size() > LightsState::kLongest || !std::ranges::all_of(why, is_printable))
    return std::nullopt;
  return LightsState{std::string(why)};
}

}  // namespace adit::panel
