#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "dispatch/report.hpp"
#include "dispatch/run.hpp"
#include "icd/status.hpp"

namespace adit::dispatch {

/// A client that waits for a report's answer; given by whoever holds its connection, never 0.
using ClientId = std::uint64_t;

/// What a client is told.
struct ClientAnswer {
  std::int64_t number = 0;  // of the report; 0: it was not taken
  /// A sentence of Adit's with its status; "": the stored answer of the report.
  icd::Status status = icd::Status::ServiceUnavailable;
  std::string sentence = "";
};

/// By when a write must be safe from a power cut. It is safe from an end of this program at once.
enum class Flush : std::uint8_t {
  Now,   // before anything follows from it
  Soon,  // within milliseconds: if it is lost, Adit finds it out again from the step before
};

/// What the rules of reports need done: by the disk, for the clients, in the log.
class Output {
 public:
  virtual ~Output() = default;

  /// Writes all of these steps, in their order, and the run if there is one, as one transaction: after true
  /// they are on disk (a report may be there more than once, with one step each). After false none is, and
  /// nothing may follow.
  virtual bool write(std::span<const Report> steps, const Run* run, Flush flush) = 0;

  /// `report` is as it now is. Does nothing if the client has gone.
  virtual void tell(ClientId client, const ClientAnswer& answer, const Report& report) = 0;
};

}  // namespace adit::dispatch
