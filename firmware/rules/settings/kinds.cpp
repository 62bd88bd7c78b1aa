#include "settings/kinds.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include "codec/field.hpp"
#include "codec/json.hpp"
#include "icd/robot_name.hpp"
#include "icd/sentence.hpp"
#include "icd/text.hpp"
#include "settings/subnet.hpp"

namespace adit::settings {
namespace {

bool is_address(const std::string& text) {
  if (text.find('\0') != std::string::npos) return false;
  in6_addr parsed{};
  return inet_pton(AF_INET, text.c_str(), &parsed) == 1 || inet_pton(AF_INET6, text.c_str(), &parsed) == 1;
}

/// Course names are parts of file names.
bool is_course(const std::string& text) {
  return is_word(text, 20);
}

/// At most `most` visible ASCII characters, without those in `without`.
bool is_name(const std::string& text, std::size_t most, std::string_view without = "") {
  if (text.size() > most || text.find_first_of(without) != std::string::npos) return false;
  for (const char c : text) {
    if (c < '!' || c > '~') return false;
  }
  return true;
}

bool are(std::string_view text, std::string_view others) {
  return std::ranges::all_of(text, [others](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || others.contains(c);
  });
}

bool is_port(std::string_view text) {
  return icd::number_in<std::uint16_t>(text) && text.front() != '0';
}

/// "http://10.0.0.20:3000", as a browser writes it (RFC 6454 6.2): in lower case, without a default port.
/// "null" is rejected, because any page can have it.
bool is_origin(std::string_view text) {
  const auto colon = text.find("://");
  if (colon == 0 || colon == std::string_view::npos) return false;
  const std::string_view scheme = text.substr(0, colon), rest = text.substr(colon + 3);
  const auto end = rest.starts_with('[') ? rest.find(']') + 1 : std::min(rest.find(':'), rest.size());
  const std::string_view host = rest.substr(0, end), port = rest.substr(end);
  const bool is_name = !host.empty() && are(host, "-.");
  const bool is_ipv6 = host.size() > 2 && is_address(std::string(host.substr(1, host.size() - 2)));
  const bool is_default = (scheme == "http" && port == ":80") || (scheme == "https" && port == ":443");
  return are(scheme, "+-.") && (host.starts_with('[') ? is_ipv6 : is_name) && !is_default &&
         (port.empty() || (port.size() > 1 && port.starts_with(':') && is_port(port.substr(1))));
}

bool are_origins(const std::string& text) {
  constexpr std::size_t kLongest = 1000;
  return text.size() <= kLongest && std::ranges::all_of(words(text), is_origin);
}

/// "off", "duplicates" or "all"
std::string range_of(std::span<const std::string_view> words) {
  std::string text;
  for (const std::string_view& word : words) {
    if (!text.empty()) text.append(&word == &words.back() ? " or " : ", ");
    text.append("\"").append(word).append("\"");
  }
  return text;
}

std::string digits(double number) {
  char text[400];  // the longest double in fixed notation has 309 digits before its point
  return {text, std::to_chars(text, text + sizeof text, number, std::chars_format::fixed).ptr};
}

/// The value for Kind::put(). std::nullopt: `value` is out of range.
std::optional<codec::Value> meant(const Kind& kind, const codec::Value& value) {
  const auto* const text = std::get_if<std::string>(&value.is);
  codec::Reading reading;
  const codec::Field field(value, reading);
  switch (kind.of) {
    case Kind::Of::Flag:
      return std::holds_alternative<bool>(value.is) ? std::optional(value) : std::nullopt;
    case Kind::Of::Version:
    case Kind::Of::Whole: {
      const auto number =
          field.whole(static_cast<std::int64_t>(kind.least), static_cast<std::int64_t>(kind.most));
      if (reading.refused()) return std::nullopt;
      return codec::Value{static_cast<std::uint64_t>(number)};
    }
    case Kind::Of::Real: {
      const double number = field.number(kind.least, kind.most);
      return reading.refused() ? std::nullopt : std::optional(codec::Value{number});
    }
    case Kind::Of::Text:
      return text != nullptr && kind.form->fits(*text) ? std::optional(value) : std::nullopt;
    case Kind::Of::Choice:
      break;
  }
  const auto found = text == nullptr ? kind.words.end() : std::ranges::find(kind.words, *text);
  if (found == kind.words.end()) return std::nullopt;
  return codec::Value{static_cast<std::uint64_t>(found - kind.words.begin())};
}

}  // namespace

constexpr Form kAddress{is_address, "an IPv4 or IPv6 address"};
/// The kernel's dev_valid_name().
constexpr Form kInterface{
    [](const std::string& text) { return is_name(text, 15, "/:") && text != "." && text != ".."; },
    "an interface's name of at most 15 characters, or \"\""};
constexpr Form kChip{[](const std::string& text) { return is_name(text, 64); },
                     "a GPIO chip's name or path, or \"\""};
/// GPIO_MAX_NAME_SIZE of linux/gpio.h, without the NUL.
constexpr Form kLine{[](const std::string& text) { return is_name(text, 31); },
                     "a GPIO line's name of at most 31 characters, or \"\""};
constexpr Form kRobot{[](const std::string& text) { return icd::RobotName::parse(text).has_value(); },
                      "1 to 10 letters, digits and underscores"};
constexpr Form kAlias{kChip.fits, "at most 64 visible ASCII characters, or \"\""};
constexpr Form kCourse{is_course, "1 to 20 letters, digits, underscores and hyphens"};
constexpr Form kCourseOrNone{[](const std::string& text) { return text.empty() || is_course(text); },
                             "a course's name, or \"\""};
constexpr Form kIpv4OrNone{[](const std::string& text) { return text.empty() || ipv4_of(text).has_value(); },
                           "an IPv4 address, or \"\""};
constexpr Form kOrigins{
    are_origins, "origins as browsers write them (http://10.0.0.20:3000) with spaces between them, or \"\""};

std::expected<void, std::string> put(const Kind& kind, const codec::Value& value, Settings& settings) {
  if (const auto member = meant(kind, value)) {
    kind.put(settings, *member);
    return {};
  }
  const std::string_view before = kind.of == Kind::Of::Whole  ? "a whole number from "
                                  : kind.of == Kind::Of::Real ? "a number from "
                                                              : "";
  return std::unexpected(icd::sentence("expected ", before, range_of(kind), ", got ", shown(value)));
}

std::string range_of(const Kind& kind) {
  switch (kind.of) {
    case Kind::Of::Flag:
      return "true or false";
    case Kind::Of::Whole:
    case Kind::Of::Real:
      return digits(kind.least) + " to " + digits(kind.most);
    case Kind::Of::Text:
      return std::string(kind.form->range);
    case Kind::Of::Choice:
      return range_of(kind.words);
    case Kind::Of::Version:
      break;
  }
  return "1";
}

codec::Value value_of(const Kind& kind, const Settings& settings) {
  codec::Value value = kind.get(settings);
  if (kind.of != Kind::Of::Choice) return value;
  return {std::string(kind.words[std::get<std::uint64_t>(value.is)])};
}

codec::Value bound_of(const Kind& kind, double bound) {
  return kind.of == Kind::Of::Whole ? codec::Value{static_cast<std::uint64_t>(bound)} : codec::Value{bound};
}

std::string_view name_of(const Kind& kind) {
  static constexpr std::string_view kNames[] = {"flag", "whole", "real", "text", "choice", "version"};
  return kNames[static_cast<std::size_t>(kind.of)];
}

bool is_word(std::string_view text, std::size_t longest) {
  return !text.empty() && text.size() <= longest && std::ranges::all_of(text, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

std::string shown(const codec::Value& value) {
  static constexpr std::size_t kLongest = 48;
  if (std::holds_alternative<codec::Value::Array>(value.is) ||
      std::holds_alternative<codec::Value::Object>(value.is)) {
    return value.kind();
  }
  std::string text = codec::write_json(value);
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  return text;
}

}  // namespace adit::settings
