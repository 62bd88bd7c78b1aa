#include "settings/kinds.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "codec/json.hpp"
#include "icd/robot_name.hpp"
#include "settings/subnet.hpp"

namespace adit::settings {
namespace {

template <class... Cases>
struct Each : Cases... {
  using Cases::operator()...;
};

std::optional<std::uint64_t> whole_number(const codec::Value& value) {
  if (const auto* number = std::get_if<std::uint64_t>(&value.is)) return *number;
  if (const auto* number = std::get_if<std::int64_t>(&value.is)) {
    return *number < 0 ? std::nullopt : std::optional(static_cast<std::uint64_t>(*number));
  }
  if (const auto* number = std::get_if<double>(&value.is)) {  // 8000.0 and 8e3 are whole, too
    const bool exact = *number >= 0 && *number <= 0x1p53 && std::trunc(*number) == *number;
    return exact ? std::optional(static_cast<std::uint64_t>(*number)) : std::nullopt;
  }
  return std::nullopt;
}

std::optional<double> real_number(const codec::Value& value) {
  if (const auto* number = std::get_if<double>(&value.is)) return *number;
  if (const auto* number = std::get_if<std::int64_t>(&value.is)) return static_cast<double>(*number);
  if (const auto* number = std::get_if<std::uint64_t>(&value.is)) return static_cast<double>(*number);
  return std::nullopt;
}

bool is_address(const std::string& text) {
  if (text.find('\0') != std::string::npos) return false;
  in6_addr parsed{};
  return inet_pton(AF_INET, text.c_str(), &parsed) == 1 || inet_pton(AF_INET6, text.c_str(), &parsed) == 1;
}

/// 1 to 20 letters, digits, `_` and `-`: a course's name stands in the name of a file.
bool is_course(const std::string& text) {
  constexpr std::size_t kLongest = 20;
  return !text.empty() && text.size() <= kLongest && std::ranges::all_of(text, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

/// At most `most` visible ASCII characters and none of `without`.
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
  std::uint32_t port = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  return error == std::errc() && end == text.data() + text.size() && text.front() != '0' && port <= 65535;
}

/// "http://10.0.0.20:3000", as a browser writes it (RFC 6454 6.2): in lower case, without a default port. Not
/// "null", which any page can have.
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

bool are_origins(std::string_view text) {
  constexpr std::size_t kLongest = 1000;
  return text.size() <= kLongest && std::ranges::all_of(words(text), is_origin);
}

bool fits(Form form, const std::string& text) {
  switch (form) {
    case Form::Address:
      return is_address(text);
    case Form::Interface:
      return is_name(text, 15, "/:") && text != "." && text != "..";  // the kernel's dev_valid_name()
    case Form::Chip:
      return is_name(text, 64);
    case Form::Robot:
      return icd::RobotName::parse(text).has_value();
    case Form::Alias:
      return is_name(text, 64);
    case Form::Course:
      return is_course(text);
    case Form::CourseOrNone:
      return text.empty() || is_course(text);
    case Form::Ipv4OrNone:
      return text.empty() || ipv4_of(text).has_value();
    case Form::Origins:
      return are_origins(text);
    case Form::Line:
      return is_name(text, 31);  // GPIO_MAX_NAME_SIZE in linux/gpio.h, less its NUL
  }
  return false;
}

std::string range_of(Form form) {
  switch (form) {
    case Form::Address:
      return "an IPv4 or IPv6 address";
    case Form::Interface:
      return "an interface's name of at most 15 characters, or \"\"";
    case Form::Chip:
      return "a GPIO chip's name or path, or \"\"";
    case Form::Robot:
      return "1 to 10 letters, digits and underscores";
    case Form::Alias:
      return "at most 64 visible ASCII characters, or \"\"";
    case Form::Course:
      return "1 to 20 letters, digits, underscores and hyphens";
    case Form::CourseOrNone:
      return "a course's name, or \"\"";
    case Form::Ipv4OrNone:
      return "an IPv4 address, or \"\"";
    case Form::Origins:
      return "origins as browsers write them (http://10.0.0.20:3000) with spaces between them, or \"\"";
    case Form::Line:
      return "a GPIO line's name of at most 31 characters, or \"\"";
  }
  return "";
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

std::unexpected<std::string> expected_but(const std::string& expected, const codec::Value& value) {
  return std::unexpected("expected " + expected + ", got " + shown(value));
}

}  // namespace

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

std::string range_of(const Kind& kind) {
  return std::visit(
      Each{[](const Flag&) { return std::string("true or false"); },
           [](const Whole& k) { return std::to_string(k.least) + " to " + std::to_string(k.most); },
           [](const Real& k) { return digits(k.least) + " to " + digits(k.most); },
           [](const Text& k) { return range_of(k.form); }, [](const Choice& k) { return range_of(k.words); },
           [](const Version&) { return std::string("1"); }},
      kind);
}

codec::Value value_of(const Kind& kind, const Settings& settings) {
  return std::visit(Each{[&](const Flag& k) { return codec::Value{k.get(settings)}; },
                         [&](const Whole& k) { return codec::Value{k.get(settings)}; },
                         [&](const Real& k) { return codec::Value{k.get(settings)}; },
                         [&](const Text& k) { return codec::Value{k.get(settings)}; },
                         [&](const Choice& k) { return codec::Value{std::string(k.words[k.get(settings)])}; },
                         [](const Version&) { return codec::Value{std::uint64_t{1}}; }},
                    kind);
}

std::string_view name_of(const Kind& kind) {
  static constexpr std::string_view kNames[] = {"flag", "whole", "real", "text", "choice", "version"};
  return kNames[kind.index()];
}

namespace {

using Put = std::expected<void, std::string>;

Put put_one(const Flag& kind, const codec::Value& value, Settings& settings) {
  const auto* flag = std::get_if<bool>(&value.is);
  if (flag == nullptr) return expected_but("true or false", value);
  kind.put(settings, *flag);
  return {};
}

Put put_one(const Whole& kind, const codec::Value& value, Settings& settings) {
  const auto number = whole_number(value);
  if (!number || *number < kind.least || *number > kind.most) {
    return expected_but("a whole number from " + range_of(kind), value);
  }
  kind.put(settings, *number);
  return {};
}

Put put_one(const Real& kind, const codec::Value& value, Settings& settings) {
  const auto number = real_number(value);
  if (!number || *number < kind.least || *number > kind.most) {
    return expected_but("a number from " + range_of(kind), value);
  }
  kind.put(settings, *number);
  return {};
}

Put put_one(const Text& kind, const codec::Value& value, Settings& settings) {
  const auto* text = std::get_if<std::string>(&value.is);
  if (text == nullptr || !fits(kind.form, *text)) return expected_but(range_of(kind.form), value);
  kind.put(settings, *text);
  return {};
}

Put put_one(const Choice& kind, const codec::Value& value, Settings& settings) {
  const auto* text = std::get_if<std::string>(&value.is);
  const auto found =
      text == nullptr ? kind.words.end() : std::ranges::find(kind.words, std::string_view(*text));
  if (found == kind.words.end()) return expected_but(range_of(kind.words), value);
  kind.put(settings, static_cast<std::size_t>(found - kind.words.begin()));
  return {};
}

Put put_one(const Version& kind, const codec::Value& value, Settings&) {
  if (whole_number(value) != 1u) return expected_but(range_of(kind), value);
  return {};
}

}  // namespace

std::expected<void, std::string> put(const Kind& kind, const codec::Value& value, Settings& settings) {
  return std::visit([&](const auto& k) { return put_one(k, value, settings); }, kind);
}

}  // namespace adit::settings
