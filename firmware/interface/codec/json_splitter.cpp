#include "codec/json_splitter.hpp"

#include <algorithm>
#include <utility>

#include "codec/byte_name.hpp"
#include "codec/json_characters.hpp"
#include "codec/json_value.hpp"
#include "icd/require.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"

namespace adit::codec {
namespace {

/// Initial memory for text: enough for every ICD message without map data.
constexpr std::size_t kSmallText = 1024;

bool starts_number(char c) {
  return c == '-' || is_digit(c);
}

}  // namespace

JsonSplitter::JsonSplitter(Split split, Most most, BulkData& data)
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
    if (auto ended = number_ended(std::nullopt); !ended) return ended;
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
    const auto text = std::make_shared<const std::string>(rest_.take());
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
  if (may_be_mark && mark_ > 0) return std::unexpected(expected("a byte order mark", in[0]));
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
  if (diverted_ == Diverted::Elements && expect_ != Expect::Separator) {
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
      if (c != ':') return std::unexpected(expected("':'", c));
      keep(":");
      expect_ = Expect::Value;
      return 1;
    case Expect::FirstKey:
      if (c == '}') return close(c);
      [[fallthrough]];
    case Expect::Key:
      if (c != '"') return std::unexpected(expected("a member's name", c));
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
  if (path_.depth() == 0) return std::unexpected(expected("the end of the document", c));
  if (c == (in_object() ? '}' : ']')) return close(c);
  if (c != ',') return std::unexpected(expected(in_object() ? "',' or '}'" : "',' or ']'", c));
  keep(",");
  expect_ = in_object() ? Expect::Key : Expect::Value;
  return 1;
}

icd::Checked<std::size_t> JsonSplitter::value(char first) {
  if (path_.at_data() || diverted_ == Diverted::Elements) {
    ADIT_TRY(divert(first));
  }
  if (diverted_ == Diverted::No && !rest_.count()) return std::unexpected(rest_.too_many_values());
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
      return std::unexpected(expected("a value", first));
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
  diverted_ = Diverted::No;  // elements contain no brackets, so this one ends them
  value_ended();
  return 1;
}

icd::Checked<std::size_t> JsonSplitter::begin_literal(std::string_view word) {
  token_ = Token::Literal;
  word_ = word;
  return 0;
}

icd::Checked<std::size_t> JsonSplitter::literal(std::string_view in) {
  if (in[0] != word_[0]) return std::unexpected(expected("true, false or null", in[0]));
  keep(word_.substr(0, 1));
  word_.remove_prefix(1);
  if (word_.empty()) value_ended();
  return 1;
}

icd::Checked<std::size_t> JsonSplitter::string(std::string_view in) {
  if (diverted_ == Diverted::Base64) {
    if (auto taken = base64_groups(in); !taken || *taken > 0) return taken;
    in = in.substr(0, base64_.missing());  // up to the next whole group
  }
  const auto piece = string_.next(in);
  if (!piece) return std::unexpected(fault_at(at_ + piece.error().at, piece.error().what));
  if (diverted_ == Diverted::Base64) {
    ADIT_TRY(decode(piece->text));
  } else {
    keep(piece->raw);
    if (token_ == Token::String) path_.text(piece->text);
  }
  if (token_ == Token::Key) path_.key_text(piece->text);
  if (piece->ended) {
    ADIT_TRY(string_ended());
  }
  return piece->taken;
}

icd::Checked<void> JsonSplitter::string_ended() {
  if (diverted_ == Diverted::Base64) {
    std::array<std::uint8_t, 2> last{};
    const auto size = base64_.finish(last);
    if (!size) return std::unexpected(bad_data(size.error()));
    if (auto taken = data_.append(std::span(last).first(*size)); !taken) return taken;
    diverted_ = Diverted::No;
    value_ended();
    return {};
  }
  keep("\"");
  if (token_ == Token::Key) {
    path_.end_key();
    token_ = Token::None;
    expect_ = Expect::Colon;
  } else {
    value_ended();
  }
  return {};
}

void JsonSplitter::value_ended() {
  token_ = Token::None;
  expect_ = Expect::Separator;
}

icd::Refusal JsonSplitter::fault_at(std::size_t at, std::string_view what) {
  return {icd::Status::BadRequest, icd::sentence("not well-formed JSON at byte ", at, ": ", what)};
}

icd::Refusal JsonSplitter::expected(std::string_view what, char got) const {
  return fault(icd::sentence("expected ", what, ", got ", byte_name(got)));
}

}  // namespace adit::codec
