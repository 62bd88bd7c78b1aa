#include "codec/json.hpp"

#include <cjson/cJSON.h>

#include <memory>
#include <optional>

#include "codec/body_decoder.hpp"
#include "codec/json_number.hpp"
#include "codec/json_splitter.hpp"
#include "codec/json_value.hpp"
#include "codec/value.hpp"
#include "codec/write.hpp"
#include "icd/text.hpp"

namespace adit::codec {
namespace {

/// Length of a short number without exponent at the start of `text`, which fits a double. 0: no such number.
std::size_t plain_number(std::string_view text) {
  constexpr std::size_t kShort = 15;
  JsonNumber grammar;
  const std::size_t length = grammar.next(text);
  const bool whole = grammar.complete() && text.substr(0, length).find_first_of("eE") == text.npos;
  const bool ended = length == text.size() || !icd::is_digit(text[length]);
  return whole && ended && length <= kShort ? length : 0;
}

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
    } else if (c == '-' || icd::is_digit(c)) {
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

std::size_t children_of(const cJSON& item) {
  return static_cast<std::size_t>(cJSON_GetArraySize(&item));
}

/// BodyDecoder::kDeepest limits the recursion.
Value value_of(const cJSON& item) {
  if (cJSON_IsBool(&item)) return {static_cast<bool>(cJSON_IsTrue(&item))};
  if (cJSON_IsNumber(&item)) return json_number_value(item.valuedouble);
  if (cJSON_IsString(&item)) return {std::string(item.valuestring)};
  if (cJSON_IsArray(&item)) {
    Value::Array array;
    array.reserve(children_of(item));
    for (const cJSON* element = item.child; element != nullptr; element = element->next) {
      array.push_back(value_of(*element));
    }
    return {std::move(array)};
  }
  if (cJSON_IsObject(&item)) {
    Value::Object object;
    object.reserve(children_of(item));
    for (const cJSON* member = item.child; member != nullptr; member = member->next) {
      object.emplace_back(member->string, value_of(*member));
    }
    return {std::move(object)};
  }
  return {};
}

/// Reads with cJSON if the document has only features that cJSON reads like RFC 8259: ASCII without escapes,
/// little nesting, short numbers, as most documents. std::nullopt: others, or not well-formed.
std::optional<Value> plain_json(std::string_view text) {
  if (!is_plain(text)) return std::nullopt;
  constexpr bool kNothingAfter = true;
  const std::string copy(text);
  const std::unique_ptr<cJSON, decltype(&cJSON_Delete)> root(
      cJSON_ParseWithLengthOpts(copy.c_str(), copy.size() + 1, nullptr, kNothingAfter), &cJSON_Delete);
  if (root == nullptr) return std::nullopt;
  return value_of(*root);
}

/// Appends one value to `text`. The value's nesting limits the recursion.
struct Writer {
  std::string& text;

  void operator()(std::nullptr_t) const { text += "null"; }
  void operator()(bool value) const { text += value ? "true" : "false"; }
  void operator()(std::int64_t value) const { text += std::to_string(value); }
  void operator()(std::uint64_t value) const { text += std::to_string(value); }
  void operator()(double value) const { text += json_number(value); }
  void operator()(const std::string& value) const { text += json_string(value); }
  void operator()(const Value::Bytes&) const { text += "null"; }
  void operator()(Value::TaggedValue) const { text += "null"; }
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

}  // namespace

std::expected<Value, std::string> parse_json(std::string_view text) {
  if (auto plain = plain_json(text)) return std::move(*plain);
  // Otherwise finds the error and its place.
  BulkData none(0);
  JsonSplitter splitter(Split::Nothing, {.text = text.size()}, none);
  if (auto fed = splitter.feed(text); !fed) return std::unexpected(std::move(fed.error().sentence));
  auto root = splitter.finish();
  if (!root) return std::unexpected(std::move(root.error().sentence));
  return std::move(*root);
}

std::string write_json(const Value& value) {
  std::string text;
  std::visit(Writer{text}, value.is);
  return text;
}

}  // namespace adit::codec
