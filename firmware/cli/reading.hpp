#pragma once

#include <cstdint>
#include <expected>
#include <string>
#include <string_view>

#include "cli/ask.hpp"
#include "cli/where.hpp"
#include "codec/row.hpp"

namespace adit::cli {

/// How Adit's JSON is read: members by their names, and one sentence for all that can be wrong.
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

/// What `parse` makes of Adit's answer, or why it is nothing that this Adit writes.
template <class Message, class Parse>
std::expected<Message, std::string> read(const codec::Value& root, Parse parse) {
  codec::Reading reading;
  auto message = reading.outcome(parse(codec::Field(root, reading)));
  if (!message) return std::unexpected("it is another version: " + message.error().sentence);
  return std::move(*message);
}
template <class Message, class Parse>
std::expected<Message, std::string> read(std::string_view json, Parse parse) {
  const auto root = codec::parse_json(json);
  if (!root) return std::unexpected("its answer is not JSON: " + root.error());
  return read<Message>(*root, parse);
}
/// The same, with where that Adit is.
template <class Message, class Json, class Parse>
std::expected<Message, std::string> read(const Adit& adit, const Json& json, Parse parse) {
  auto message = read<Message>(json, parse);
  if (message) return message;
  return std::unexpected("cannot read the answer of Adit at " + written(adit.address) + ": " +
                         message.error());
}

/// The row, or the rows, that Adit's answer is.
template <class Row, class Json>
std::expected<Row, std::string> read(const Adit& adit, const Json& json) {
  return read<Row>(adit, json, [](const codec::Field& root) {
    Row row;
    codec::KindOf<Row>::read(root, row);
    return row;
  });
}

}  // namespace adit::cli
