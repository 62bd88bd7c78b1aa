#pragma once

#include <expected>
#include <string_view>

namespace adit::intake {

/// RFC 9110 5.6.2: a method, or the name of a field; never empty.
bool is_token(std::string_view text);

/// No control character but the tab (RFC 9110 5.5); bytes over 0x7f may stand.
bool has_no_controls(std::string_view text);

/// Equal but for the case of ASCII letters.
bool same_word(std::string_view a, std::string_view b);

/// Without the blanks and tabs around it (RFC 9110 5.6.3).
std::string_view without_blanks(std::string_view text);

/// A field's line without its CRLF.
struct FieldLine {
  std::string_view name, value;
};

/// Its name and value, or a sentence that says why it is none (RFC 9112 5).
std::expected<FieldLine, std::string_view> parse_field_line(std::string_view line);

/// `host [":" port]` (RFC 9110 7.2, RFC 3986 3.2.2); may be empty; no user information.
bool is_authority(std::string_view text);

}  // namespace adit::intake
