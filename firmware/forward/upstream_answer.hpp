#pragma once

#include "intake/server.hpp"
#include "uplink/connection.hpp"

namespace adit::forward {

/// What a client is told of the Command Post's answer: its status, and its bytes if these are JSON of a 2xx
/// answer or a JSON string; else a JSON string (ICD 4.1) with `detail` of an object, or that says what came
/// instead (404 and 500 may be HTML, 501 is empty). An answer of 2xx that is no JSON becomes 502.
intake::Answer client_answer(const uplink::Answered& answered);

}  // namespace adit::forward
