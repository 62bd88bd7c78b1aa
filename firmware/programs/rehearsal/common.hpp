#pragma once

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <expected>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "command_line/program.hpp"
#include "icd/sentence.hpp"
#include "icd/text.hpp"

// Common to both programs of this folder.

namespace adit {

/// An error of these parts, joined to a sentence.
template <class... Parts>
std::unexpected<std::string> wrong(const Parts&... parts) {
  return std::unexpected(icd::sentence(parts...));
}

/// Stores an option's value as Parse reads it. The error of Parse is a sentence.
template <auto Parse, class Into>
command_line::ValueSetter parsed_value(Into& into) {
  return command_line::set_by<[](Into& place, const std::string& text) -> command_line::Wrong {
    auto read = Parse(text);
    if (!read) return std::move(read.error());
    place = *std::move(read);
    return std::nullopt;
  }>(into);
}

/// A numeric IPv4 or IPv6 address and a TCP port.
struct Address {
  std::string host;
  std::uint16_t port = 0;

  /// "127.0.0.1:8000", "[::1]:8000".
  std::string text() const {
    const bool is_ipv6 = host.contains(':');
    return icd::sentence(is_ipv6 ? "[" : "", host, is_ipv6 ? "]:" : ":", port);
  }
};

/// Reads "127.0.0.1:8000" or "[::1]:8000". The host is not checked. The error is a sentence.
inline std::expected<Address, std::string> read_address(std::string_view text, std::uint16_t least_port) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos) return wrong("no port");
  std::string_view host = text.substr(0, colon);
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  const auto port = icd::number_in<std::uint16_t>(text.substr(colon + 1));
  if (!port || *port < least_port) return wrong("the port is not a number from ", least_port, " to 65535");
  return Address{std::string(host), *port};
}

/// The token in a file, without the white space around it. The error names the file, never its content.
inline std::expected<std::string, std::string> read_token(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) return wrong(path.string(), ": cannot be read");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  std::string token(icd::trim(text));
  const bool is_visible = std::ranges::all_of(token, [](char c) { return c > 0x20 && c < 0x7f; });
  if (!token.empty() && is_visible) return token;
  return wrong(path.string(), ": expected one token of visible ASCII characters");
}

/// To standard output, at once.
inline void print(const std::string& text) {
  (void)std::fwrite(text.data(), 1, text.size(), stdout);
  (void)std::fflush(stdout);
}

/// Counts `key`. Once there are `most` keys, a new one counts as `others`.
template <class Counts>
void count_bounded(Counts& counts, const typename Counts::key_type& key,
                   const typename Counts::key_type& others, std::size_t most) {
  ++counts[counts.size() < most || counts.contains(key) ? key : others];
}

/// Filled up with blanks before it.
inline std::string aligned_right(const std::string& text, std::size_t width) {
  return std::string(width - std::min(width, text.size()), ' ') + text;
}

/// Signals that the main thread alone takes. To be called before any other thread begins.
inline sigset_t block_signals(std::initializer_list<int> numbers) {
  sigset_t signals;
  (void)sigemptyset(&signals);
  for (const int number : numbers) (void)sigaddset(&signals, number);
  (void)pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  return signals;
}

}  // namespace adit
