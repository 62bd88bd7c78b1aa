#pragma once

#include <string>

#include "codec/field.hpp"
#include "codec/json.hpp"
#include "icd/status.hpp"

namespace adit::api {

/// What `read` makes of a body, which is one JSON object.
template <class Message, class Read>
icd::Checked<Message> read_body(const std::string& body, Read read) {
  const auto root = codec::parse_json(body);
  if (!root) return std::unexpected(icd::Refusal{icd::Status::BadRequest, "expected JSON: " + root.error()});
  codec::Reading reading;
  return reading.outcome<Message>(read(codec::Field(*root, reading)));
}

}  // namespace adit::api
