#pragma once

#include <functional>
#include <string>

#include "icd/artifact_report.hpp"
#include "icd/map_update.hpp"
#include "icd/markers_update.hpp"
#include "icd/run_status.hpp"
#include "icd/state_update.hpp"
#include "icd/status.hpp"
#include "icd/uri.hpp"
#include "intake/server.hpp"

namespace adit::intake {

/// Who sent a message and how large it came.
struct Sender {
  std::string address;
  std::size_t bytes = 0;   // of the body as received
  bool resubmits = false;  // a report: to be sent as a new one, though it be the same as an earlier one
};

/// What the team's messages are handed to once they have passed every check. Called on the loop.
class Desk {
 public:
  virtual ~Desk() = default;

  /// Queues the message, or says why not (a queue is full: 429). On success the sender is answered 200
  /// `null`.
  virtual icd::Checked<void> take(icd::MapUpdate update, const Sender& sender) = 0;
  virtual icd::Checked<void> take(const icd::StateUpdate& update, const Sender& sender) = 0;
  virtual icd::Checked<void> take(const icd::MarkersUpdate& update, const Sender& sender) = 0;

  /// Answers later, with the Command Post's own answer.
  virtual void take(const icd::ArtifactReport& report, const Sender& sender,
                    std::shared_ptr<Responder> responder) = 0;
  virtual void status(const Sender& sender, std::shared_ptr<Responder> responder) = 0;

  /// A message was refused with this; the sender has been told.
  virtual void refused(icd::Uri uri, const Sender& sender, const icd::Refusal& refusal) = 0;
};

}  // namespace adit::intake
