#pragma once

#include <string>
#include <string_view>

#include "intake/server.hpp"

struct MHD_Response;

namespace adit::intake {

/// True for a field value that cannot end its line: visible ASCII, blanks, and bytes over 0x7f (RFC
/// 9110 5.5).
bool is_field_value(std::string_view text);

/// 503, with the sentence and when to try again.
Answer no_room(std::string_view sentence);

/// For libmicrohttpd; fields that are none are left out. Null where there is no memory. The body is taken out
/// of the answer, not copied: it may be megabytes.
MHD_Response* make_response(Answer& answer);

/// The whole answer as it goes over the wire, after which the connection ends. For when libmicrohttpd takes
/// no answer: in the middle of a body, or of the head.
std::string last_answer_text(const Answer& answer, bool with_body);

}  // namespace adit::intake
