#pragma once

#include <string>
#include <string_view>

#include "codec/field.hpp"
#include "codec/json.hpp"
#include "icd/refuse.hpp"

namespace adit::api {

/// Applies `read` to a body, which must be one JSON object.
template <class Message, class Read>
icd::Checked<Message> read_body(const std::string& body, Read read) {
  const auto root = codec::parse_json(body);
  if (!root) return icd::refuse(icd::Status::BadRequest, "expected JSON: ", root.error());
  codec::Reading reading;
  return reading.outcome<Message>(read(codec::Field(*root, reading)));
}

/// The text of the member `name` of a body.
inline icd::Checked<std::string> read_text(const std::string& body, std::string_view name) {
  return read_body<std::string>(
      body, [name](const codec::Field& root) { return std::string(root.member(name).text()); });
}

}  // namespace adit::api
