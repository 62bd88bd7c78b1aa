#include "intake/head.hpp"

#include <algorithm>
#include <utility>

#include "codec/utf8.hpp"
#include "icd/text.hpp"

namespace adit::intake {
namespace {

using icd::is_digit, icd::is_letter_or_digit;

bool is_ip_literal(std::string_view text) {
  return text.size() > 2 && std::ranges::all_of(text.substr(1, text.size() - 2), [](char letter) {
           return is_letter_or_digit(letter) || letter == ':' || letter == '.';
         });
}

bool is_registered_name(std::string_view text) {
  return std::ranges::all_of(text, [](char letter) {
    return is_letter_or_digit(letter) || std::string_view("-._~%!$&'()*+,;=").contains(letter);
  });
}

}  // namespace

bool is_token_letter(char letter) {
  return is_letter_or_digit(letter) || std::string_view("!#$%&'*+-.^_`|~").contains(letter);
}

bool is_token(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, is_token_letter);
}

bool has_no_controls(std::string_view text) {
  return std::ranges::all_of(text, [](char letter) {
    const auto byte = static_cast<unsigned char>(letter);
    return byte == '\t' || (byte >= 0x20 && byte != 0x7f);
  });
}

std::expected<FieldLine, std::string_view> parse_field_line(std::string_view line) {
  if (line.starts_with(' ') || line.starts_with('\t')) {
    return std::unexpected("a header field: must not be folded over lines");  // RFC 9112 5.2
  }
  const auto colon = line.find(':');
  if (colon == std::string_view::npos) {
    return std::unexpected("a header field: expected a name, a colon and a value");
  }
  const std::string_view name = line.substr(0, colon), value = line.substr(colon + 1);
  if (name.empty())
    return std::unexpected("a header field: expected a name before the colon");  // RFC 9110 5.1
  if (name.ends_with(' ') || name.ends_with('\t')) {
    return std::unexpected("a header field: expected no blank before the colon");  // RFC 9112 5.1
  }
  if (!is_token(name)) return std::unexpected("a header field: its name has a character that is not allowed");
  if (!has_no_controls(value))
    return std::unexpected("a header field: must have no control characters");  // RFC 9110 5.5
  return FieldLine{.name = name, .value = icd::trim(value, kBlanks)};
}

bool is_authority(std::string_view text) {
  const auto bracket = text.starts_with('[') ? text.find(']') : 0;
  if (bracket == std::string_view::npos) return false;
  const auto colon = text.find(':', bracket);
  const std::string_view name = text.substr(0, colon);
  const std::string_view port = colon == std::string_view::npos ? "" : text.substr(colon + 1);
  return (bracket > 0 ? is_ip_literal(name) && name.ends_with(']') : is_registered_name(name)) &&
         std::ranges::all_of(port, is_digit);
}

namespace {

int hex_digit(char letter) {
  if (letter >= '0' && letter <= '9') return letter - '0';
  const char small = static_cast<char>(letter | 0x20);
  return small >= 'a' && small <= 'f' ? small - 'a' + 10 : -1;
}

bool is_text(std::string_view bytes) {
  return !bytes.contains('\0') && codec::is_utf8(bytes);
}

enum class Plus { Stays, IsSpace };

std::optional<std::string> decode(std::string_view raw, Plus plus) {
  std::string text;
  text.reserve(raw.size());
  for (std::size_t i = 0; i < raw.size(); ++i) {
    if (raw[i] == '%') {
      if (raw.size() - i < 3) return std::nullopt;
      const int high = hex_digit(raw[i + 1]);
      const int low = hex_digit(raw[i + 2]);
      if (high < 0 || low < 0) return std::nullopt;
      text.push_back(static_cast<char>(high * 16 + low));
      i += 2;
    } else {
      text.push_back(raw[i] == '+' && plus == Plus::IsSpace ? ' ' : raw[i]);
    }
  }
  if (!is_text(text)) return std::nullopt;
  return text;
}

/// The absolute form (RFC 9112 3.2.2) without its scheme and authority.
std::string_view origin_form(std::string_view raw) {
  const auto scheme_end = raw.find("://");
  if (raw.starts_with('/') || scheme_end == std::string_view::npos) return raw;
  const auto path = raw.find('/', scheme_end + 3);
  return path == std::string_view::npos ? "/" : raw.substr(path);
}

}  // namespace

std::optional<Target> parse_target(std::string_view raw) {
  raw = origin_form(raw);
  raw = raw.substr(0, raw.find('#'));
  const auto mark = raw.find('?');
  auto path = decode(raw.substr(0, mark), Plus::Stays);
  if (!path || (!path->starts_with('/') && *path != "*")) return std::nullopt;

  Target target{.path = std::move(*path), .query = {}};
  std::string_view rest = mark == std::string_view::npos ? std::string_view{} : raw.substr(mark + 1);
  while (!rest.empty()) {
    const std::string_view pair = rest.substr(0, rest.find('&'));
    rest.remove_prefix(std::min(pair.size() + 1, rest.size()));
    const auto equals = pair.find('=');
    auto name = decode(pair.substr(0, equals), Plus::IsSpace);
    auto value = decode(equals == std::string_view::npos ? std::string_view{} : pair.substr(equals + 1),
                        Plus::IsSpace);
    if (!name || !value) return std::nullopt;
    target.query.emplace_back(std::move(*name), std::move(*value));
  }
  return target;
}

HeadParts parts_of(std::string_view head) {
  head.remove_prefix(head.find_first_not_of("\r\n"));  // RFC 9112 2.2: empty lines before it
  const std::string_view line = head.substr(0, head.find('\r'));
  const auto first = line.find(' '), last = line.rfind(' ');
  return {.method = line.substr(0, first),
          .target = line.substr(first + 1, last - first - 1),
          .fields = head.substr(line.size() + 2)};
}

Head::Head(std::string text, Target target, const std::string& peer, const std::string& local, bool is_secure,
           std::optional<std::uint64_t> length)
    : text_(std::move(text)),
      target_(std::move(target)),
      peer_(peer),
      local_(local),
      is_secure_(is_secure),
      length_(length) {
  const HeadParts parts = parts_of(text_);
  method_ = parts.method;
  fields_.reserve(16);
  for (std::string_view left = parts.fields; !left.starts_with('\r');) {
    const std::string_view line = left.substr(0, left.find('\r'));
    const std::string_view name = line.substr(0, line.find(':'));
    fields_.push_back({.name = name, .value = icd::trim(line.substr(name.size() + 1), kBlanks)});
    left.remove_prefix(line.size() + 2);
  }
}

std::string_view Head::query(std::string_view name) const {
  for (const auto& [key, value] : target_.query) {
    if (key == name) return value;
  }
  return {};
}

std::string_view Head::header(std::string_view name) const {
  for (const FieldLine& field : fields_) {
    if (icd::equals_ignoring_case(field.name, name)) return field.value;
  }
  return {};
}

}  // namespace adit::intake
