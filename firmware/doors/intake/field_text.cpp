#include "intake/field_text.hpp"

#include <algorithm>

#include "icd/letter_case.hpp"
#include "icd/text.hpp"

namespace adit::intake {
namespace {

using icd::is_digit, icd::is_letter_or_digit;

bool is_token_letter(char letter) {
  return is_letter_or_digit(letter) || std::string_view("!#$%&'*+-.^_`|~").contains(letter);
}

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
  return FieldLine{.name = name, .value = icd::trimmed(value, kBlanks)};
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

}  // namespace adit::intake
