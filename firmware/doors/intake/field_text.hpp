#pragma once

#include <expected>
#include <string_view>

namespace adit::intake {

/// True for a token: the name of a method or of a field, not empty (RFC 9110 5.6.2).
bool is_token(std::string_view text);

/// True if the only control character is the tab. Bytes above 0x7f are allowed (RFC 9110 5.5).
bool has_no_controls(std::string_view text);

inline constexpr std::string_view kBlanks = " \t";  // RFC 9110 5.6.3

/// A field of a head.
struct FieldLine {
  std::string_view name, value;
};

/// Parses a field's line without its CRLF (RFC 9112 5). The error is a sentence.
std::expected<FieldLine, std::string_view> parse_field_line(std::string_view line);

/// True for `host [":" port]` without user information (RFC 9110 7.2, RFC 3986 3.2.2); may be empty.
bool is_authority(std::string_view text);

}  // namespace adit::intake
