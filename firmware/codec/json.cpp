#include "codec/json.hpp"

#include <cmath>

#include "codec/json_splitter.hpp"
#include "codec/list.hpp"
#include "codec/plain_json.hpp"
#include "codec/write.hpp"
#include "icd/sentence.hpp"

namespace adit::codec {
namespace {

/// Appends one value to `text`. The value's nesting limits the recursion.
struct Writer {
  std::string& text;

  void operator()(std::nullptr_t) const { text += "null"; }
  void operator()(bool value) const { text += value ? "true" : "false"; }
  void operator()(std::int64_t value) const { text += std::to_string(value); }
  void operator()(std::uint64_t value) const { text += std::to_string(value); }
  void operator()(double value) const { text += std::isfinite(value) ? icd::real_text(value) : "null"; }
  void operator()(const std::string& value) const { text += json_string(value); }
  void operator()(const Value::Bytes&) const { text += "null"; }
  void operator()(Value::UnderTag) const { text += "null"; }
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
