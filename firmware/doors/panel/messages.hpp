#pragma once

#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "loop/file_descriptor.hpp"
#include "panel/panel.hpp"
#include "settings/settings.hpp"

namespace adit::panel {

/// Non-blocking packet sockets in the file system (SOCK_SEQPACKET). Empty, with errno, after an error.
loop::FileDescriptor connected_to(const std::string& path);
/// For this user only. Replaces a file at `path`.
loop::FileDescriptor listening_at(const std::string& path);
/// The next connection. EAGAIN: there is none.
loop::FileDescriptor accepted_at(const loop::FileDescriptor& listening);

/// Messages between aditd and adit-panel: one packet each, as text, at most this many bytes.
inline constexpr std::size_t kLongestMessage = 1024;

/// "lit 1100": aditd is well and wants these lights. Sent at each change and repeatedly.
struct LightRequest {
  Lit lit{};
};
/// "end": aditd ends by itself. The lights become dark.
struct EndRequest {};
/// "panel {...}": the lines from the settings, in the format of a board's file, with all members.
struct LinesRequest {
  settings::Panel panel;
};
using Message = std::variant<LightRequest, EndRequest, LinesRequest>;

std::string message_of(const LightRequest& message);
std::string message_of(const EndRequest& message);
std::string message_of(const LinesRequest& message);
/// Parses a message of the three kinds. An error says what is wrong.
std::expected<Message, std::string> parse_message(std::string_view text);

/// From adit-panel: "button 1", pressed; "button 0", not pressed; "button gone", it cannot be read and a
/// press is cancelled.
struct ButtonState {
  std::optional<bool> pressed;  // nullopt: it cannot be read
  friend bool operator==(const ButtonState&, const ButtonState&) = default;
};
/// "lights 1": the lights are as requested; "lights 0 panel: line H...": they cannot be set, and why.
struct LightsState {
  static constexpr std::size_t kLongest = 500;  // characters of `trouble`, all printable ASCII
  std::string trouble;                          // or ""
  friend bool operator==(const LightsState&, const LightsState&) = default;
};
using PanelReport = std::variant<ButtonState, LightsState>;

std::string message_of(const ButtonState& said);
/// Shortens `trouble` to kLongest and replaces other characters by "?".
std::string message_of(const LightsState& said);
/// nullopt: unknown message.
std::optional<PanelReport> parse_report(std::string_view text);

}  // namespace adit::panel
