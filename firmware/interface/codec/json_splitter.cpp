#include "codec/json_splitter.hpp"

#include <algorithm>
#include <utility>

#include "codec/json_number.hpp"
#include "codec/json_value.hpp"
#include "codec/utf8.hpp"
#include "icd/require.hpp"
#include "icd/sentence.hpp"
#include "icd/text.hpp"
#include "icd/try.hpp"

namespace adit::codec {
namespace {

bool is_hex(char c) {
  return icd::is_digit(c) || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F');
}

/// Requires four hex digits.
char32_t unit(std::string_view digits) {
  const auto value = icd::number_in<unsigned>(digits, 16);
  icd::require(digits.size() == 4 && value);
  return *value;
}

constexpr const char* kLone = "a surrogate without its partner in a string";

}  // namespace

std::expected<JsonString::Piece, Fault> JsonString::next(std::string_view in) {
  icd::require(!in.empty());
  if (!escape_.empty()) return escape(in);
  auto run = plain(in);
  if (!run || run->taken > 0) return run;
  if (in[0] == '\\') return escape(in);
  return std::unexpected(Fault{0, "a raw control character in a string (" + byte_name(in[0]) + ")"});
}

std::expected<JsonString::Piece, Fault> JsonString::plain(std::string_view in) {
  std::size_t n = 0;
  while (n < in.size()) {
    if (utf8_.complete()) {
      while (n < in.size() && is_plain(in[n])) ++n;
      if (n == in.size() || static_cast<unsigned char>(in[n]) < 0x80) break;
    }
    if (!utf8_.next(static_cast<std::uint8_t>(in[n]))) {
      if (n > 0) break;  // returns the good part first
      return std::unexpected(Fault{n, "a string that is not UTF-8 (" + byte_name(in[n]) + ")"});
    }
    ++n;
  }
  const std::string_view run = in.substr(0, n);
  const bool ended = utf8_.complete() && n < in.size() && in[n] == '"';
  return Piece{.taken = ended ? n + 1 : n, .raw = run, .text = run, .ended = ended};
}

std::expected<JsonString::Piece, Fault> JsonString::escape(std::string_view in) {
  for (std::size_t n = 0; n < in.size(); ++n) {
    const auto ends = feed_escape(in[n]);
    if (!ends) return std::unexpected(Fault{n, ends.error()});
    if (!*ends) continue;
    finished_.swap(escape_);
    escape_.clear();
    return Piece{.taken = n + 1, .raw = finished_, .text = meaning_};
  }
  return Piece{.taken = in.size(), .raw = {}, .text = {}};
}

std::expected<bool, const char*> JsonString::feed_escape(char c) {
  const std::size_t place = escape_.size();
  escape_.push_back(c);
  if (place == 0) return false;  // the backslash
  if (place == 1) {
    constexpr std::string_view kShort = "\"\\/bfnrt";
    constexpr std::string_view kShortMeans = "\"\\/\b\f\n\r\t";
    if (c == 'u') return false;
    const std::size_t which = kShort.find(c);
    if (which == std::string_view::npos) return std::unexpected("an escape that JSON does not have");
    meaning_ = kShortMeans[which];
    return true;
  }
  if (place == 6) return c == '\\' ? std::expected<bool, const char*>(false) : std::unexpected(kLone);
  if (place == 7) return c == 'u' ? std::expected<bool, const char*>(false) : std::unexpected(kLone);
  if (!is_hex(c)) return std::unexpected("an escape \\u without four hex digits");
  return place == 5 || place == 11 ? finish_unicode_escape() : false;
}

std::expected<bool, const char*> JsonString::finish_unicode_escape() {
  const char32_t first = unit(std::string_view(escape_).substr(2, 4));
  meaning_.clear();
  if (escape_.size() == 6) {
    if (first >= 0xD800 && first <= 0xDBFF) return false;  // the other half must follow
    if (first >= 0xDC00 && first <= 0xDFFF) return std::unexpected(kLone);
    append_utf8(meaning_, first);
    return true;
  }
  const char32_t second = unit(std::string_view(escape_).substr(8, 4));
  if (second < 0xDC00 || second > 0xDFFF) return std::unexpected(kLone);
  append_utf8(meaning_, 0x10000 + ((first - 0xD800) << 10) + (second - 0xDC00));
  return true;
}

namespace {

/// Initial memory for text: enough for every ICD message without map data.
constexpr std::size_t kSmallText = 1024;

bool starts_number(char c) {
  return c == '-' || icd::is_digit(c);
}

}  // namespace

JsonSplitter::JsonSplitter(Split split, DocumentLimits most, BulkData& data)
    : split_(split), data_(data), path_(split), rest_(most) {}

icd::Checked<void> JsonSplitter::feed(std::string_view bytes) {
  if (whole_) {
    const SharedText text = std::exchange(whole_, std::nullopt)->text;
    ADIT_TRY(read(*text));
  } else if (at_ == 0 && split_ != Split::MapData && bytes.size() <= rest_.most().text) {
    const auto text = std::make_shared<const std::string>(bytes);
    auto root = split_ == Split::Lists ? json_value_with_lists(text, rest_.most().values)
                                       : json_value(*text, rest_.most().values);
    if (root) whole_ = {.text = text, .root = *std::move(root)};
    if (whole_) return {};
  }
  return read(bytes);
}

icd::Checked<void> JsonSplitter::read(std::string_view bytes) {
  if (at_ == 0) rest_.reserve(std::min(bytes.size(), kSmallText));
  while (!bytes.empty()) {
    const auto taken = ADIT_TRY(step(bytes));
    bytes.remove_prefix(taken);
    at_ += taken;
    if (!rest_.fits(number_.text.size())) return std::unexpected(rest_.too_large());
  }
  return {};
}

icd::Checked<void> JsonSplitter::end() {
  if (token_ == Token::Number) {
    if (auto ended = finish_number(std::nullopt); !ended) return ended;
  }
  if (at_ == 0) return std::unexpected(fault("an empty document"));
  if (path_.depth() > 0 || token_ != Token::None || expect_ != Expect::Separator) {
    return std::unexpected(fault("the document is cut short"));
  }
  return {};
}

icd::Checked<Value> JsonSplitter::finish() {
  if (whole_) return std::move(whole_->root);
  ADIT_TRY(end());
  if (split_ == Split::Lists) {
    const auto text = std::make_shared<const std::string>(rest_.take_text());
    if (auto root = json_value_with_lists(text, rest_.values())) return *std::move(root);
    return std::unexpected(too_many_outside_lists(kMostOutsideLists));
  }
  auto root = json_value(rest_.text());
  icd::require(root.has_value());
  if (data_.form() != DataForm::Absent) mark_split_out(*root);
  return *std::move(root);
}

icd::Checked<std::size_t> JsonSplitter::step(std::string_view in) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  const bool may_be_mark = mark_ == at_ && mark_ < kByteOrderMark.size();
  if (may_be_mark && in[0] == kByteOrderMark[mark_]) {
    ++mark_;
    return 1;
  }
  if (may_be_mark && mark_ > 0) return std::unexpected(mismatch("a byte order mark", in[0]));
  switch (token_) {
    case Token::None:
      return structure(in);
    case Token::Key:
    case Token::String:
      return string(in);
    case Token::Number:
      return number(in);
    case Token::Literal:
      break;
  }
  return literal(in);
}

icd::Checked<std::size_t> JsonSplitter::structure(std::string_view in) {
  if (diverted_ == Diversion::Elements && expect_ != Expect::Separator) {
    if (auto taken = plain_elements(in); !taken || *taken > 0) return taken;
  }
  if (is_blank(in[0])) {
    return static_cast<std::size_t>(std::ranges::find_if_not(in, is_blank) - in.begin());
  }
  const char c = in[0];
  switch (expect_) {
    case Expect::Separator:
      return separator(c);
    case Expect::Colon:
      if (c != ':') return std::unexpected(mismatch("':'", c));
      keep(":");
      expect_ = Expect::Value;
      return 1;
    case Expect::FirstKey:
      if (c == '}') return close(c);
      [[fallthrough]];
    case Expect::Key:
      if (c != '"') return std::unexpected(mismatch("a member's name", c));
      keep("\"");
      path_.begin_key();
      token_ = Token::Key;
      return 1;
    case Expect::FirstElement:
      if (c == ']') return close(c);
      break;
    case Expect::Value:
      break;
  }
  return value(c);
}

icd::Checked<std::size_t> JsonSplitter::separator(char c) {
  if (path_.depth() == 0) return std::unexpected(mismatch("the end of the document", c));
  if (c == (is_in_object() ? '}' : ']')) return close(c);
  if (c != ',') return std::unexpected(mismatch(is_in_object() ? "',' or '}'" : "',' or ']'", c));
  keep(",");
  expect_ = is_in_object() ? Expect::Key : Expect::Value;
  return 1;
}

icd::Checked<std::size_t> JsonSplitter::value(char first) {
  if (path_.is_at_data() || diverted_ == Diversion::Elements) {
    ADIT_TRY(divert(first));
  }
  if (diverted_ == Diversion::No && !rest_.count()) return std::unexpected(rest_.too_many_values());
  if (starts_number(first)) {
    number_.grammar = {};
    number_.at = at_;
    token_ = Token::Number;
    return 0;
  }
  switch (first) {
    case '"':
      keep("\"");
      token_ = Token::String;
      return 1;
    case '{':
    case '[':
      return open(first);
    case 't':
      return begin_literal("true");
    case 'f':
      return begin_literal("false");
    case 'n':
      return begin_literal("null");
    default:
      return std::unexpected(mismatch("a value", first));
  }
}

icd::Checked<std::size_t> JsonSplitter::open(char bracket) {
  if (path_.depth() == objects_.size()) {
    return std::unexpected(fault(icd::sentence("nested deeper than ", BodyDecoder::kDeepest)));
  }
  const bool object = bracket == '{';
  keep(object ? "{" : "[");
  objects_[path_.depth()] = object;
  path_.open();
  expect_ = object ? Expect::FirstKey : Expect::FirstElement;
  return 1;
}

icd::Checked<std::size_t> JsonSplitter::close(char bracket) {
  keep(bracket == '}' ? "}" : "]");
  path_.close();
  diverted_ = Diversion::No;  // elements contain no brackets, so this one ends them
  end_value();
  return 1;
}

icd::Checked<std::size_t> JsonSplitter::begin_literal(std::string_view word) {
  token_ = Token::Literal;
  word_ = word;
  return 0;
}

icd::Checked<std::size_t> JsonSplitter::literal(std::string_view in) {
  if (in[0] != word_[0]) return std::unexpected(mismatch("true, false or null", in[0]));
  keep(word_.substr(0, 1));
  word_.remove_prefix(1);
  if (word_.empty()) end_value();
  return 1;
}

icd::Checked<std::size_t> JsonSplitter::string(std::string_view in) {
  if (diverted_ == Diversion::Base64) {
    if (auto taken = base64_groups(in); !taken || *taken > 0) return taken;
    in = in.substr(0, base64_.missing());  // up to the next whole group
  }
  const auto piece = string_.next(in);
  if (!piece) return std::unexpected(fault_at(at_ + piece.error().at, piece.error().what));
  if (diverted_ == Diversion::Base64) {
    ADIT_TRY(decode(piece->text));
  } else {
    keep(piece->raw);
    if (token_ == Token::String) path_.text(piece->text);
  }
  if (token_ == Token::Key) path_.key_text(piece->text);
  if (piece->ended) {
    ADIT_TRY(finish_string());
  }
  return piece->taken;
}

icd::Checked<void> JsonSplitter::finish_string() {
  if (diverted_ == Diversion::Base64) {
    std::array<std::uint8_t, 2> last{};
    const auto size = base64_.finish(last);
    if (!size) return std::unexpected(bad_data(size.error()));
    if (auto taken = data_.append(std::span(last).first(*size)); !taken) return taken;
    diverted_ = Diversion::No;
    end_value();
    return {};
  }
  keep("\"");
  if (token_ == Token::Key) {
    path_.end_key();
    token_ = Token::None;
    expect_ = Expect::Colon;
  } else {
    end_value();
  }
  return {};
}

void JsonSplitter::end_value() {
  token_ = Token::None;
  expect_ = Expect::Separator;
}

icd::Refusal JsonSplitter::fault_at(std::size_t at, std::string_view what) {
  return {icd::Status::BadRequest, icd::sentence("not well-formed JSON at byte ", at, ": ", what)};
}

icd::Refusal JsonSplitter::mismatch(std::string_view what, char got) const {
  return fault(icd::sentence("expected ", what, ", got ", byte_name(got)));
}

}  // namespace adit::codec
