#pragma once

#include <functional>
#include <memory>
#include <string>

#include "icd/mapping.hpp"
#include "icd/scoring.hpp"
#include "icd/status.hpp"
#include "icd/uri.hpp"
#include "intake/server.hpp"

namespace adit::intake {

/// The sender of a message, and the message's size.
struct Sender {
  std::string address;
  std::size_t bytes = 0;  // of the body as received
  /// When the upload began and when it was whole, as places in the order of all beginnings and ends; from 1.
  std::uint64_t began = 0, ended = 0;
  /// The first beginning among this address's other uploads to the URI that are not over; 0: there are none.
  std::uint64_t overlaps = 0;
  bool resubmits = false;  // a report to send as a new one, even if it equals an earlier one
};

/// A map that is arriving. The destructor discards it unless accept() was called.
class MapArrival {
 public:
  virtual ~MapArrival() = default;

  /// Stores `bytes` of the map's data after the earlier bytes, so that they need not stay in memory. Then
  /// calls `done` on the loop with the bytes for which there was no room.
  virtual void store(icd::ChunkedBytes bytes, std::function<void(icd::ChunkedBytes left)> done) = 0;
  /// All stored bytes. For any thread, but not while store() is running.
  virtual icd::Checked<icd::ChunkedBytes> stored_bytes() = 0;

  /// Stores and queues the whole, checked map. Then calls `done` on the loop: the map survives a process
  /// restart, or the refusal says why not (a queue is full: 429; there is no room: 503). The sender is
  /// answered after that. Costs least if the map's data begins with stored_bytes().
  virtual void accept(icd::MapUpdate update, const Sender& sender,
                      std::function<void(icd::Checked<void>)> done) = 0;
};

/// Accepts the team's messages after all checks. Called on the loop.
class MessageHandler {
 public:
  virtual ~MessageHandler() = default;

  virtual std::shared_ptr<MapArrival> begin_map() = 0;
  /// Queues the message, or returns the refusal (queue full: 429). On success the sender gets 200 `null`.
  virtual icd::Checked<void> accept(icd::StateUpdate update, const Sender& sender) = 0;
  /// The same. Calls `done` on the loop, at once or later.
  virtual void accept(icd::MarkersUpdate update, const Sender& sender,
                      std::function<void(icd::Checked<void>)> done) = 0;

  /// Answers later, with the Command Post's answer.
  virtual void accept(const icd::ArtifactReport& report, const Sender& sender,
                      std::shared_ptr<Responder> responder) = 0;
  virtual void status(const Sender& sender, std::shared_ptr<Responder> responder) = 0;

  /// A part of a message was dropped: records `why`. accept() follows. The sender does not learn of it.
  virtual void record_dropped(icd::Uri uri, const Sender& sender, const std::string& why) = 0;
  /// Records that a message was rejected. The sender has the answer.
  virtual void on_rejected(icd::Uri uri, const Sender& sender, const icd::Refusal& refusal) = 0;
};

}  // namespace adit::intake
