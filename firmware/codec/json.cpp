#include "codec/json.hpp"

#include <cmath>

#include "codec/json_number.hpp"
#include "codec/json_splitter.hpp"
#include "codec/json_value.hpp"
#include "codec/list.hpp"
#include "codec/write.hpp"
#include "icd/sentence.hpp"

namespace adit::codec {
namespace {

/// Writes one value after what `text` holds. Recursion ends with the value's nesting.
struct Writer {
  std::string& text;

  void operator()(std::nullptr_t) const { text += "null"; }
  void operator()(bool value) const { text += value ? "true" : "false"; }
  void operator()(std::int64_t value) const { text += std::to_string(value); }
  void operator()(std::uint64_t value) const { text += std::to_string(value); }
  void operator()(double value) const { text += std::isfinite(value) ? icd::real_text(value) : "null"; }
  void operator()(const std::string& value) const { text += json_string(value); }
  void operator()(const Value::Bytes&) const { text += "null"; }
  void operator()(Value::SplitOut) const { text += "null"; }

  void operator()(const Value::Array& array) const {
    text += '[';
    for (const char* between = ""; const Value& element : array) {
      text += std::exchange(between, ",");
      std::visit(*this, element.is);
    }
    text += ']';
  }

  void operator()(const std::shared_ptr<const List>& list) const {
    Value::Array array;
    for (std::size_t i = 0; i < list->size(); ++i) array.push_back(list->element(i).value_or(Value()));
    (*this)(array);
  }

  void operator()(const Value::Object& object) const {
    text += '{';
    for (const char* between = ""; const auto& [key, value] : object) {
      text += std::exchange(between, ",");
      text += json_string(key);
      text += ':';
      std::visit(*this, value.is);
    }
    text += '}';
  }
};

/// The length of a number at the start of `text`: a short one without exponent, which is surely a double. 0:
/// none, or another.
std::size_t plain_number(std::string_view text) {
  constexpr std::size_t kShort = 15;
  JsonNumber grammar;
  const std::size_t length = grammar.next(text);
  const bool whole = grammar.complete() && text.substr(0, length).find_first_of("eE") == text.npos;
  const bool ended = length == text.size() || text[length] < '0' || text[length] > '9';
  return whole && ended && length <= kShort ? length : 0;
}

/// Whether cJSON alone reads the text as RFC 8259 has it: ASCII without escapes, shallow, its numbers short.
/// Most of what is read in one piece is like that, and then needs no second look.
bool is_plain(std::string_view text) {
  const auto printable = [text](std::size_t at) {
    return at < text.size() && text[at] >= ' ' && text[at] <= '~';
  };
  std::size_t depth = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (c == '"') {
      do {
        if (!printable(++at) || text[at] == '\\') return false;
      } while (text[at] != '"');
    } else if (c == '-' || (c >= '0' && c <= '9')) {
      const std::size_t length = plain_number(text.substr(at));
      if (length == 0) return false;
      at += length - 1;
    } else if (c == '{' || c == '[') {
      if (++depth > BodyDecoder::kDeepest) return false;
    } else if (!printable(at) && c != '\n' && c != '\r' && c != '\t') {
      return false;
    }
  }
  return true;
}

}  // namespace

std::expected<Value, std::string> parse_json(std::string_view text) {
  if (is_plain(text)) {
    if (auto root = json_value(std::string(text))) return std::move(*root);
  }
  // Else it says what is wrong, and where.
  BulkData none(0);
  JsonSplitter splitter(Split::Nothing, {.text = text.size()}, none);
  if (auto fed = splitter.feed(text); !fed) return std::unexpected(std::move(fed.error().sentence));
  auto root = splitter.finish();
  if (!root) return std::unexpected(std::move(root.error().sentence));
  return std::move(*root);
}

bool is_json(std::string_view text) {
  BulkData none(0);
  JsonSplitter splitter(Split::Nothing, {.text = text.size()}, none);
  return splitter.feed(text) && splitter.end();
}

std::string write_json(const Value& value) {
  std::string text;
  std::visit(Writer{text}, value.is);
  return text;
}

}  // namespace adit::codec
