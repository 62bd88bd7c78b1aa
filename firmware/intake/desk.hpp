#pragma once

#include <functional>
#include <memory>
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

/// Who sent a message, and its size as it came.
struct Sender {
  std::string address;
  std::size_t bytes = 0;         // of the body as received
  std::uint64_t connection = 0;  // RequestHead::connection()
  bool resubmits = false;        // a report: to be sent as a new one, though it be the same as an earlier one
};

/// A map on its way in. Dropped before it is taken, nothing of it is left.
class MapArrival {
 public:
  virtual ~MapArrival() = default;

  /// Stores `bytes` of its data, which follow those before, so that they need not be held in memory. Then
  /// calls `done` on the loop with the rest for which there was no room.
  virtual void store(icd::ChunkedBytes bytes, std::function<void(icd::ChunkedBytes left)> done) = 0;
  /// All that was stored. For any thread, while nothing is being stored.
  virtual icd::Checked<icd::ChunkedBytes> stored() = 0;

  /// It is whole and checked. Keeps and queues it, and calls `done` on the loop once it is kept, so that it
  /// outlives the service, or with why not (a queue is full: 429; there is no room: 503). Then its sender is
  /// answered. Costs least where its data begins with stored().
  virtual void take(icd::MapUpdate update, const Sender& sender,
                    std::function<void(icd::Checked<void>)> done) = 0;
};

/// Takes the team's messages once they have passed every check. Called on the loop.
class Desk {
 public:
  virtual ~Desk() = default;

  /// A map begins to come.
  virtual std::shared_ptr<MapArrival> map_arrives() = 0;
  /// Queues the message, or says why not (a queue is full: 429). On success the sender is answered 200
  /// `null`.
  virtual icd::Checked<void> take(icd::StateUpdate update, const Sender& sender) = 0;
  /// The same; says so by `done` on the loop, maybe later.
  virtual void take(icd::MarkersUpdate update, const Sender& sender,
                    std::function<void(icd::Checked<void>)> done) = 0;

  /// Answers later, with the Command Post's own answer.
  virtual void take(const icd::ArtifactReport& report, const Sender& sender,
                    std::shared_ptr<Responder> responder) = 0;
  virtual void status(const Sender& sender, std::shared_ptr<Responder> responder) = 0;

  /// Something of a message that is about to be taken was left out, and why; the sender is not told.
  virtual void left_out(icd::Uri uri, const Sender& sender, const std::string& why) = 0;
  /// A message was refused with this; the sender has been told.
  virtual void refused(icd::Uri uri, const Sender& sender, const icd::Refusal& refusal) = 0;
};

}  // namespace adit::intake
