#pragma once

#include "intake/server.hpp"
#include "uplink/connection.hpp"

namespace adit::forward {

/// What a client is told of the Command Post's answer: its status and bytes if these are JSON (ICD 4), else
/// the status with a JSON string that says what came instead (404 and 500 may be HTML, 501 is empty). An
/// answer of 2xx that is no JSON becomes 502.
intake::Answer client_answer(const uplink::Answered& answered);

}  // namespace adit::forward
