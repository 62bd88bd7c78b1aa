#pragma once

#include "rehearsal/command_post/command_post.hpp"

namespace adit::rehearsal {

/// The control port, for tests: POST /start, /stop (admin stop), /resume, /end give the run's new state, or
/// 409 where the run's state does not allow it; GET /record gives all that was counted.
Outcome control(CommandPost& post, const Request& request);

}  // namespace adit::rehearsal
