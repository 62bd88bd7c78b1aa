#pragma once

#include <string>
#include <string_view>

#include "intake/server.hpp"

struct MHD_Response;

namespace adit::intake {

/// An error answer with `sentence` as a JSON string.
Answer error_answer(icd::Status status, std::string_view sentence);

/// Lets a web page of any origin read the answer and its headers (Fetch, CORS protocol).
void allow_any_origin(Answer& answer);

/// True if `text` is a field value: not empty, without control characters except the tab (RFC 9110 5.5).
bool is_field_value(std::string_view text);

/// Makes the response for libmicrohttpd, and leaves out invalid fields. A 429 or 503 without Retry-After gets
/// Retry-After: 1, because some libraries else retry at once. Null if there is no memory. Moves the
/// body out of `answer`, because it may be megabytes.
MHD_Response* make_response(Answer& answer);

/// The same as bytes, after which the connection is closed. Use this when libmicrohttpd cannot queue
/// an answer: in the middle of a head or a body.
std::string last_answer_text(const Answer& answer, bool with_body);

}  // namespace adit::intake
