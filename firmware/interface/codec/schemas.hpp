#pragma once

#include <algorithm>
#include <array>
#include <initializer_list>
#include <stdexcept>
#include <string_view>

#include "codec/row.hpp"

namespace adit::codec {

/// OpenAPI's components.schemas of rows: {"Report": {...}, ...}. An unsupported schema stops the build.
class Schemas {
 public:
  static constexpr std::size_t kLongest = 49152;

  /// Writes these named rows and all rows that they refer to.
  consteval explicit Schemas(std::initializer_list<const Schema*> roots) {
    for (const Schema* const root : roots) remember(*root);
    add("{");
    for (std::size_t i = 0; i < count_; ++i) {
      const Schema schema = named_[i];
      begin(name_of(schema), "{");
      add_body(schema);
      add("}");
    }
    add("}");
    char* const text = text_.data();
    for (std::size_t i = size_; i < kLongest; ++i) text[i] = ' ';
  }

  /// JSON, padded with spaces.
  constexpr std::array<char, kLongest> text() const { return text_; }

 private:
  /// Includes the members of rows without a member name.
  static constexpr void each_member(const Row& row, auto&& done) {
    for (const Member& member : row.members) {
      if (member.name.empty()) {
        for (const Member& inner : member.kind->schema->row->members) done(inner);
      } else {
        done(member);
      }
    }
  }

  static constexpr std::string_view name_of(const Schema& schema) {
    return schema.row == nullptr ? schema.name : schema.row->name;
  }

  /// Uses pointers, because compilers limit the steps of a constant.
  constexpr void add(std::string_view part) {
    char* const to = text_.data() + size_;
    const char* const from = part.data();
    const std::size_t size = part.size();
    for (std::size_t i = 0; i < size; ++i) to[i] = from[i];
    size_ += size;
  }
  constexpr void begin_item() {
    if (text_[size_ - 1] != '{' && text_[size_ - 1] != '[') add(",");
  }
  /// Writes a member's name and the start of its value.
  constexpr void begin(std::string_view name, std::string_view value = "") {
    begin_item();
    add_text(name);
    add(":");
    add(value);
  }
  constexpr void add(std::string_view name, std::int64_t number) {
    std::array<char, 20> digits{};
    std::size_t first = digits.size();
    do {
      digits[--first] = static_cast<char>('0' + number % 10);
      number /= 10;
    } while (number > 0);
    begin(name, {&digits[first], digits.size() - first});
  }
  static constexpr std::int64_t to_integer(double bound) {
    const auto number = static_cast<std::int64_t>(bound);
    if (static_cast<double>(number) != bound) throw std::invalid_argument("not written here");
    return number;
  }
  constexpr void add_text(std::string_view text) {
    const char* const letters = text.data();
    const std::size_t size = text.size();
    for (std::size_t i = 0; i < size; ++i)
      if (letters[i] == '"' || letters[i] == '\\') throw std::invalid_argument("not written here");
    add("\"");
    add(text);
    add("\"");
  }

  constexpr void remember(Schema schema) {
    schema.or_null = false;
    const auto is_same = [&](const Schema& other) { return name_of(other) == name_of(schema); };
    if (!std::any_of(named_.begin(), named_.begin() + count_, is_same)) named_[count_++] = schema;
  }

  /// The members of a schema at its use.
  constexpr void add_schema(const Schema& schema) {
    const bool is_simple = schema.row == nullptr && schema.name.empty();
    if (schema.or_null && !is_simple) begin("oneOf", R"([{"type":"null"},{)");
    if (name_of(schema).empty()) {
      add_body(schema);
    } else {
      remember(schema);
      begin("$ref", R"("#/components/schemas/)");
      add(name_of(schema));
      add("\"");
    }
    if (schema.or_null && !is_simple) add("}]");
  }

  constexpr void add_body(const Schema& schema) {
    if (schema.row != nullptr) return add_row(*schema.row);
    if (!schema.type.empty()) {
      begin("type", schema.or_null ? "[" : "");
      add_text(schema.type);
      if (schema.or_null) add(R"(,"null"])");
    }
    if (schema.items != nullptr) {
      begin("items", "{");
      add_schema(*schema.items);
      add("}");
    }
    if (schema.least) add("minimum", *schema.least);
    if (schema.fewest > 0) add("minItems", static_cast<std::int64_t>(schema.fewest));
    if (schema.most > 0) add("maxItems", static_cast<std::int64_t>(schema.most));
    if (schema.more.empty()) return;
    begin_item();
    add(schema.more);
  }

  constexpr void add_row(const Row& row) {
    begin("type", R"("object")");
    add_meaning(row.meaning);
    begin("properties", "{");
    each_member(row, [this](const Member& member) {
      begin(member.name, "{");
      add_member(member);
      add("}");
    });
    add("}");
    begin("required", "[");
    each_member(row, [this](const Member& member) {
      if (!member.is_needed) return;
      begin_item();
      add_text(member.name);
    });
    add("]");
    begin("additionalProperties", "false");
  }

  constexpr void add_member(const Member& member) {
    Schema schema = *member.kind->schema;
    schema.or_null = schema.or_null && member.is_needed;
    if (member.least) schema.least = to_integer(*member.least);
    add_schema(schema);
    if (!member.words.empty()) {
      begin("enum", "[");
      for (const std::string_view word : member.words) {
        begin_item();
        add_text(word);
      }
      add(schema.or_null ? ",null]" : "]");
    }
    if (member.most) add("maximum", to_integer(*member.most));
    add_meaning(member.meaning);
  }

  constexpr void add_meaning(std::string_view meaning) {
    if (meaning.empty()) return;
    begin("description");
    add_text(meaning);
  }

  std::array<Schema, 64> named_{};
  std::size_t count_ = 0;
  std::array<char, kLongest> text_{};
  std::size_t size_ = 0;
};

}  // namespace adit::codec
