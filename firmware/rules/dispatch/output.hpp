#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "dispatch/report.hpp"
#include "dispatch/runs.hpp"
#include "icd/status.hpp"

namespace adit::dispatch {

/// A client that waits for an answer; assigned by the owner of its connection, never 0.
using ClientId = std::uint64_t;

struct ClientAnswer {
  std::int64_t number = 0;  // of the report; 0: not accepted
  /// Adit's sentence, with `status`. If empty, the client gets the report's stored answer.
  icd::Status status = icd::Status::ServiceUnavailable;
  std::string sentence = "";
};

/// When a write must survive a power cut. It survives the end of the process at once.
enum class Flush : std::uint8_t {
  Now,   // before write() returns
  Soon,  // within milliseconds; the run's status can replace it
};

/// The rules' way to the disk and to the clients.
class Output {
 public:
  virtual ~Output() = default;

  /// Writes the steps in order, and `run` if not null, as one transaction. A report may have several steps.
  /// False: no step is on disk, and the caller must not act on any.
  virtual bool write(std::span<const Report> steps, const Run* run, Flush flush) = 0;

  /// Answers the client, unless it has disconnected. `report` is in its new state.
  virtual void answer_client(ClientId client, const ClientAnswer& answer, const Report& report) = 0;
};

}  // namespace adit::dispatch
