#pragma once

#include <expected>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

#include "codec/field.hpp"
#include "codec/json.hpp"

/// The small files by which aditd and the programs with more rights speak, and in which these keep what
/// lasts: each is one object of JSON with the number of its format and exactly the members that it must have.
namespace adit::network::file_object {

/// `format`: the name of the member that has the number.
std::string written(std::string_view format, codec::Value::Object members);

/// Refuses any member but these, and `besides`.
void only(const codec::Field& object, std::initializer_list<std::string_view> names,
          std::string_view besides = "");

/// Refuses any format but this Adit's.
void expect_format(const codec::Field& object, std::string_view format);

std::string text(const codec::Field& object, std::string_view name);

/// What `make` makes of the object, or a sentence about the first thing that is not as it must be.
template <class Message, class Make>
std::expected<Message, std::string> read(std::string_view json, std::string_view format,
                                         std::initializer_list<std::string_view> names, Make make) {
  const auto root = codec::parse_json(json);
  if (!root) return std::unexpected("no JSON: " + root.error());
  codec::Reading reading;
  const codec::Field field(*root, reading);
  only(field, names, format);
  expect_format(field, format);
  auto message = reading.outcome<Message>(make(field));
  if (!message) return std::unexpected(message.error().sentence);
  return std::move(*message);
}

}  // namespace adit::network::file_object
