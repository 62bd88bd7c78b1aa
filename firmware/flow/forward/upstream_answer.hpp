#pragma once

#include "intake/server.hpp"
#include "uplink/connection.hpp"

namespace adit::forward {

/// The client's answer, with the same status. JSON of a 2xx and JSON strings are copied. An object becomes
/// the string of its `detail` (ICD 4.1), other bytes a sentence (404 and 500 may be HTML, 501 is empty). A
/// 2xx without JSON becomes 502.
intake::Answer client_answer(const uplink::Answered& answered);

}  // namespace adit::forward
