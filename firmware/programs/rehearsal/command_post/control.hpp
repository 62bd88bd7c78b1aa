#pragma once

#include "rehearsal/command_post/command_post.hpp"

namespace adit::rehearsal {

/// The control port, for tests and for whoever leads a rehearsal:
///  POST /start, /stop (admin stop), /resume, /end: the run's new state, or 409 where its state does not
///    allow it
///  POST /new-run: another run, whatever became of this one; the body, where there is one, may say
///    {"run": "2", "team": "other", "started": false}
///  POST /other-sender: a report on the same token that the client knows nothing of; the body, where there is
///    one, is that report
///  POST, GET and DELETE /faults: appends to what goes wrong next, shows what is left, and clears it
///  GET /record: all that was counted
///  POST /posted: what adit-robots posted so far (Arrivals::told); its answer and that to GET /arrivals: how
///  old
///    maps were when they came, as rows and as a table to print
Outcome control(CommandPost& post, const Request& request);

}  // namespace adit::rehearsal
