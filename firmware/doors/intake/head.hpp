#pragma once

#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "intake/server.hpp"

namespace adit::intake {

/// True for a character of a token (RFC 9110 5.6.2).
bool is_token_letter(char letter);

/// True for a token: the name of a method or of a field, not empty (RFC 9110 5.6.2).
bool is_token(std::string_view text);

/// True if the only control character is the tab. Bytes above 0x7f are allowed (RFC 9110 5.5).
bool has_no_controls(std::string_view text);

inline constexpr std::string_view kBlanks = " \t";  // RFC 9110 5.6.3

struct FieldLine {
  std::string_view name, value;
};

/// Parses a field's line without its CRLF (RFC 9112 5). The error is a sentence.
std::expected<FieldLine, std::string_view> parse_field_line(std::string_view line);

/// True for `host [":" port]` without user information (RFC 9110 7.2, RFC 3986 3.2.2); may be empty.
bool is_authority(std::string_view text);

/// A request's target (RFC 9112 3.2), percent-decoded once.
struct Target {
  std::string path;
  std::vector<std::pair<std::string, std::string>> query;  // in the order given
};

/// Parses the origin form, the absolute form and `*`. nullopt for another form, a NUL or invalid UTF-8.
std::optional<Target> parse_target(std::string_view raw);

/// The parts of a head that HeadChecker has found whole.
struct HeadParts {
  std::string_view method, target;
  std::string_view fields;  // the lines of the fields
};
HeadParts parts_of(std::string_view head);

class Head final : public RequestHead {
 public:
  /// `text`: a head that HeadChecker has found whole. `target`: its target.
  Head(std::string text, Target target, const std::string& peer, const std::string& local, bool is_secure,
       std::optional<std::uint64_t> length);
  Head(const Head&) = delete;
  Head& operator=(const Head&) = delete;

  std::string_view method() const override { return method_; }
  std::string_view path() const override { return target_.path; }
  std::string_view query(std::string_view name) const override;
  std::string_view header(std::string_view name) const override;
  std::optional<std::uint64_t> content_length() const override { return length_; }
  const std::string& peer() const override { return peer_; }
  const std::string& local() const override { return local_; }
  bool is_secure() const override { return is_secure_; }

 private:
  std::string text_;
  std::string_view method_;  // this and fields_ are in text_
  std::vector<FieldLine> fields_;
  Target target_;
  const std::string& peer_;
  const std::string& local_;
  bool is_secure_;
  std::optional<std::uint64_t> length_;
};

}  // namespace adit::intake
