#pragma once

#include <algorithm>
#include <array>
#include <initializer_list>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "codec/row.hpp"

namespace adit::codec {

/// OpenAPI's components.schemas of rows: {"Report": {"type": "object", ...}, ...}. Only the compiler writes
/// it; what it cannot write stops the build.
class Schemas {
 public:
  static constexpr std::size_t kLongest = 32768;

  /// Of those rows, which have names, and of all that they name.
  consteval explicit Schemas(std::initializer_list<const Schema*> roots) {
    text_.fill(' ');
    for (const Schema* const root : roots) remember(*root);
    add("{");
    for (std::size_t i = 0; i < count_; ++i) {
      const Schema& schema = *named_[i];
      add(i == 0 ? "" : ",");
      add_text(name_of(schema));
      add(":{");
      add_body(schema, schema.least);
      add("}");
    }
    add("}");
  }

  /// JSON, with spaces behind it.
  constexpr std::array<char, kLongest> text() const { return text_; }

 private:
  /// Also those of a row whose members stand among these.
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

  constexpr void add(std::string_view part) {
    for (const char letter : part) text_[size_++] = letter;
  }
  constexpr void add(std::string_view name, std::int64_t number) {
    std::array<char, 20> digits{};
    add(name);
    std::size_t begin = digits.size();
    do {
      digits[--begin] = static_cast<char>('0' + number % 10);
      number /= 10;
    } while (number > 0);
    add({&digits[begin], digits.size() - begin});
  }
  constexpr void add_text(std::string_view text) {
    if (text.find_first_of("\"\\") != text.npos) throw std::invalid_argument("not written here");
    add("\"");
    add(text);
    add("\"");
  }

  constexpr void remember(const Schema& schema) {
    const auto is_same = [&](const Schema* other) { return name_of(*other) == name_of(schema); };
    if (!std::any_of(named_.begin(), named_.begin() + count_, is_same)) named_[count_++] = &schema;
  }

  /// The members of a schema where it is used.
  constexpr void add_schema(const Schema& schema, std::optional<std::int64_t> least) {
    const bool is_simple = schema.row == nullptr && schema.name.empty();
    if (schema.or_null && !is_simple) add(R"("oneOf":[{"type":"null"},{)");
    if (name_of(schema).empty()) {
      add_body(schema, least);
    } else {
      remember(schema);
      add(R"("$ref":"#/components/schemas/)");
      add(name_of(schema));
      add("\"");
    }
    if (schema.or_null && !is_simple) add("}]");
  }

  constexpr void add_body(const Schema& schema, std::optional<std::int64_t> least) {
    if (schema.row != nullptr) return add_row(*schema.row);
    add(schema.or_null ? R"("type":[)" : R"("type":)");
    add_text(schema.type);
    if (schema.or_null) add(R"(,"null"])");
    if (schema.items != nullptr) {
      add(R"(,"items":{)");
      add_schema(*schema.items, schema.items->least);
      add("}");
    }
    if (least) add(R"(,"minimum":)", *least);
    if (schema.fewest > 0) add(R"(,"minItems":)", static_cast<std::int64_t>(schema.fewest));
    if (schema.most > 0) add(R"(,"maxItems":)", static_cast<std::int64_t>(schema.most));
    if (!schema.more.empty()) add(",");
    add(schema.more);
  }

  constexpr void add_row(const Row& row) {
    add(R"("type":"object")");
    add_meaning(row.meaning);
    add(R"(,"properties":{)");
    each_member(row, [this, first = true](const Member& member) mutable {
      add(first ? "" : ",");
      first = false;
      add_text(member.name);
      add(":{");
      add_member(member);
      add("}");
    });
    add(R"(},"required":[)");
    each_member(row, [this, first = true](const Member& member) mutable {
      add(first ? "" : ",");
      first = false;
      add_text(member.name);
    });
    add(R"(],"additionalProperties":false)");
  }

  constexpr void add_member(const Member& member) {
    const Schema& schema = *member.kind->schema;
    add_schema(schema, member.least ? member.least : schema.least);
    if (!member.words.empty()) {
      add(R"(,"enum":)");
      for (const std::string_view& word : member.words) {
        add(&word == member.words.data() ? "[" : ",");
        add_text(word);
      }
      add(schema.or_null ? ",null]" : "]");
    }
    if (member.most) add(R"(,"maximum":)", *member.most);
    add_meaning(member.meaning);
  }

  constexpr void add_meaning(std::string_view meaning) {
    if (meaning.empty()) return;
    add(R"(,"description":)");
    add_text(meaning);
  }

  std::array<const Schema*, 64> named_{};
  std::size_t count_ = 0;
  std::array<char, kLongest> text_{};
  std::size_t size_ = 0;
};

}  // namespace adit::codec
