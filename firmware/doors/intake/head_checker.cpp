#include "intake/head_checker.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "icd/sentence.hpp"
#include "icd/text.hpp"
#include "icd/uri.hpp"
#include "intake/head.hpp"

namespace adit::intake {
namespace {

/// RFC 6585 5 and RFC 9110 15.6.6. Only this file answers with them.
constexpr icd::Status kFieldsTooLarge{431}, kVersionNotSupported{505};

constexpr std::string_view kRequestLine =
    "request line: expected a method, a target and HTTP/1.1, with one blank between them";

/// Visible ASCII and bytes above it, because parse_target() accepts UTF-8.
bool is_target_text(std::string_view text) {
  return has_no_controls(text) && !text.contains('\t');
}

bool is_version(std::string_view text) {
  return text.size() == 8 && text.starts_with("HTTP/") && icd::is_digit(text[5]) && text[6] == '.' &&
         icd::is_digit(text[7]);
}

std::size_t count_of(std::string_view text, char letter) {
  return static_cast<std::size_t>(std::ranges::count(text, letter));
}

}  // namespace

HeadChecker::Place HeadChecker::place_of(std::string_view so_far, std::string_view part) {
  return {.at = part.empty() ? 0 : static_cast<std::size_t>(part.data() - so_far.data()),
          .size = part.size()};
}

HeadChecker::Verdict HeadChecker::check(std::string_view so_far) {
  while (verdict_ == Verdict::More) {
    const auto end = std::min(so_far.find('\n', looked_at_), so_far.size());
    if (end >= kMostBytes) {
      refuse("the head of the request: expected at most 16384 bytes", kFieldsTooLarge);
      break;
    }
    looked_at_ = end;
    if (end == so_far.size()) break;
    ++looked_at_;
    line(so_far, so_far.substr(line_begin_, end - line_begin_));
    line_begin_ = looked_at_;
  }
  return verdict_;
}

void HeadChecker::line(std::string_view so_far, std::string_view line) {
  if (!line.ends_with('\r')) {  // RFC 9112 2.2 allows a bare LF; a proxy may differ
    refuse("the head of the request: each line must end in CRLF");
    return;
  }
  line.remove_suffix(1);
  if (!request_line_came_) {
    if (!line.empty()) request_line(so_far, line);  // RFC 9112 2.2: ignore empty lines before it
  } else if (line.empty()) {
    end(so_far);
  } else {
    field(so_far, line);
  }
}

/// RFC 9112 3
void HeadChecker::request_line(std::string_view so_far, std::string_view line) {
  request_line_came_ = true;
  const auto first = line.find(' '), last = line.rfind(' ');
  if (first == std::string_view::npos || first == last) return refuse(kRequestLine);
  const std::string_view method = line.substr(0, first);
  const std::string_view asked = line.substr(first + 1, last - first - 1);
  const std::string_view version = line.substr(last + 1);
  if (!is_token(method) || asked.empty() || asked.contains(' ') || !is_version(version)) {
    refuse(kRequestLine);
  } else if (!version.starts_with("HTTP/1.")) {  // RFC 9110 15.6.6
    refuse(icd::sentence("request line: expected HTTP/1.1, got ", version), kVersionNotSupported);
  } else {
    is_version_1_0_ = version.ends_with('0');
    is_head_method_ = method == "HEAD";
    const auto parsed = parse_target(asked);
    names_icd_uri_ = parsed && icd::uri_of(parsed->path);
    target(so_far, method, asked);
  }
}

/// RFC 9112 3.2
void HeadChecker::target(std::string_view so_far, std::string_view method, std::string_view target) {
  constexpr std::string_view kScheme = "http://";
  count(count_of(target, '&'));
  if (!is_target_text(target)) {
    refuse("request target: must have no control characters");
  } else if (icd::equals_ignoring_case(target.substr(0, kScheme.size()), kScheme)) {
    const std::string_view after = target.substr(kScheme.size());
    const std::string_view authority = after.substr(0, after.find_first_of("/?#"));
    authority_ = place_of(so_far, authority);
  } else if (!target.starts_with('/') && (target != "*" || method != "OPTIONS")) {
    refuse("request target: expected a path, percent-encoded");
  }
}

void HeadChecker::field(std::string_view so_far, std::string_view line) {
  const auto field = parse_field_line(line);
  if (!field) return refuse(field.error());
  count(1);
  if (icd::equals_ignoring_case(field->name, "Host")) {
    host(so_far, field->value);
  } else if (icd::equals_ignoring_case(field->name, "Content-Length")) {
    content_length(field->value);
  } else if (icd::equals_ignoring_case(field->name, "Transfer-Encoding")) {
    transfer_encoding(field->value);
  } else if (icd::equals_ignoring_case(field->name, "Cookie")) {
    cookie(field->value);
  } else {
    check_single(so_far, *field);
  }
}

/// RFC 9110 5.3: a field that is not a list occurs once. A repeated equal value has one meaning for all
/// readers, except in Content-Encoding (8.4), a list: there it would mean a second coding.
void HeadChecker::check_single(std::string_view so_far, const FieldLine& field) {
  static constexpr std::array<std::string_view, 4> kNames = {"Content-Type", "Authorization", "Origin",
                                                             "Content-Encoding"};
  const auto* const name = std::ranges::find_if(
      kNames, [&](std::string_view each) { return icd::equals_ignoring_case(each, field.name); });
  if (name == kNames.end()) return;
  auto& before = single_[static_cast<std::size_t>(name - kNames.begin())];
  if (!before) {
    before = place_of(so_far, field.value);
  } else if (*name == kNames.back() || so_far.substr(before->at, before->size) != field.value) {
    refuse(icd::sentence(*name, ": given twice"));
  }
}

/// RFC 9112 3.2
void HeadChecker::host(std::string_view so_far, std::string_view value) {
  if (host_) {
    refuse("Host: given twice");
  } else if (!is_authority(value)) {
    refuse("Host: expected an address or a name, and optionally a port");
  } else {
    host_ = place_of(so_far, value);
  }
}

/// RFC 9110 8.6, RFC 9112 6.3
void HeadChecker::content_length(std::string_view value) {
  if (std::exchange(has_length_, true)) return refuse("Content-Length: given twice");
  const auto length = icd::number_in<std::uint64_t>(value);
  if (!length || *length > static_cast<std::uint64_t>(INT64_MAX))
    return refuse("Content-Length: expected a whole number");
  framing_ = {.has_body = *length > 0, .length = length};
}

/// RFC 9112 6.1, 7
void HeadChecker::transfer_encoding(std::string_view value) {
  if (std::exchange(has_coding_, true) || !icd::equals_ignoring_case(value, "chunked")) {
    refuse("Transfer-Encoding: expected only chunked");
  }
}

/// libmicrohttpd has one block of memory for the head, a record for each part, and a copy of the cookies.
void HeadChecker::cookie(std::string_view value) {
  count(count_of(value, ';') + count_of(value, ','));
  cookie_bytes_ += value.size();
  if (cookie_bytes_ > kMostCookieBytes) {
    refuse("Cookie: expected at most 4096 bytes", kFieldsTooLarge);
  }
}

void HeadChecker::end(std::string_view so_far) {
  const auto text = [&](const Place& place) { return so_far.substr(place.at, place.size); };
  if (!host_ && !is_version_1_0_) {
    refuse("Host: missing");  // RFC 9112 3.2
  } else if (authority_ && (!host_ || !icd::equals_ignoring_case(text(*authority_), text(*host_)))) {
    refuse("request target: its address differs from Host");  // RFC 9112 3.2.2
  } else if (has_coding_ && has_length_) {
    refuse("Content-Length: not allowed with Transfer-Encoding");  // RFC 9112 6.3
  } else if (has_coding_ && is_version_1_0_) {
    refuse("Transfer-Encoding: not allowed in HTTP/1.0");  // RFC 9112 6.1
  } else if (verdict_ == Verdict::More) {
    if (has_coding_) framing_ = {.has_body = true, .length = std::nullopt};
    framing_.is_version_1_0 = is_version_1_0_;
    verdict_ = Verdict::Whole;
  }
}

void HeadChecker::count(std::size_t parts) {
  parts_ += parts;
  if (parts_ > kMostParts) {
    refuse("the head of the request: expected at most 128 header fields, query parameters and cookies",
           kFieldsTooLarge);
  }
}

/// The first refusal is kept.
void HeadChecker::refuse(std::string_view sentence, icd::Status status) {
  if (std::exchange(verdict_, Verdict::Refused) == Verdict::Refused) return;
  refusal_ = {.status = status, .sentence = std::string(sentence)};
}

}  // namespace adit::intake
