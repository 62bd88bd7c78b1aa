#pragma once

#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "codec/field.hpp"
#include "codec/json.hpp"

namespace adit::cli {

/// How the page's JSON is read: members by their names, and one sentence for all that can be wrong.
template <class Integer>
Integer whole(const codec::Field& object, std::string_view name) {
  return object.member(name).whole<Integer>();
}

inline std::string text(const codec::Field& object, std::string_view name) {
  return std::string(object.member(name).text());
}

inline double number(const codec::Field& object, std::string_view name) {
  return object.member(name).number();
}

inline std::optional<double> number_or_null(const codec::Field& object, std::string_view name) {
  const codec::Field field = object.member(name);
  return field.is_absent() ? std::nullopt : std::optional(field.number());
}

/// Counts are never negative, and JSON's are below 2^63.
inline std::uint64_t count(const codec::Field& object, std::string_view name) {
  return static_cast<std::uint64_t>(object.member(name).whole<std::int64_t>(0));
}

template <class Row>
std::vector<Row> rows(const codec::Field& array, Row (*read)(const codec::Field&)) {
  std::vector<Row> all;
  for (std::size_t i = 0; i < array.size() && !array.reading().refused(); ++i)
    all.push_back(read(array.element(i)));
  return all;
}

/// What `parse` makes of the document, or why it is nothing that this Adit writes.
template <class Message, class Parse>
std::expected<Message, std::string> read(std::string_view json, Parse parse) {
  const auto root = codec::parse_json(json);
  if (!root) return std::unexpected("its answer is no JSON: " + root.error());
  codec::Reading reading;
  auto message = reading.outcome(parse(codec::Field(*root, reading)));
  if (!message) {
    return std::unexpected("its answer is not of this version of Adit: " + message.error().sentence);
  }
  return std::move(*message);
}

}  // namespace adit::cli
