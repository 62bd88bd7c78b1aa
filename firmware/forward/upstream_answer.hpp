#pragma once

#include "intake/server.hpp"
#include "uplink/connection.hpp"

namespace adit::forward {

/// The answer that a client gets for the Command Post's: the same status. The bytes stay the same if they are
/// JSON of a 2xx answer or a JSON string. An object becomes a JSON string (ICD 4.1) of its `detail`; other
/// bytes become a sentence (404 and 500 may be HTML, 501 is empty). A 2xx that is not JSON becomes 502.
intake::Answer client_answer(const uplink::Answered& answered);

}  // namespace adit::forward
