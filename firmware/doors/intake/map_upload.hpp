#pragma once

#include <memory>
#include <vector>

#include "codec/body_decoder.hpp"
#include "icd/rules.hpp"
#include "intake/worker_upload.hpp"
#include "loop/workers.hpp"

namespace adit::intake {

struct MapUploadOptions {
  codec::BodyKind kind;
  icd::Rules rules;
  std::size_t most_bytes = 0;                  // the most of the body
  std::shared_ptr<UploadBudget> without_room;  // for maps that are held because they cannot be stored
};

/// Receives a map. A worker decodes the body as it arrives, one job at a time. The client must wait while
/// more than kPending bytes wait for the worker. Decoded data is stored kStored bytes or more at a time. If
/// as much again is decoded before that is stored, the worker pauses. So a large map is never in memory as a
/// whole. If a grid says before its data that it is a grid, as most do, its cells are gzipped as they are
/// decoded (codec::PressedCells), and the map is nearly packed when its last byte arrives.
///
/// A compressed body may grow a thousandfold. It is decoded in steps of little more than kStored, and its
/// decoded size counts in the budget. If it cannot be stored, it stays in memory until it is checked. All
/// such maps together have kWithoutRoom; a map that needs more is rejected.
///
/// A whole, checked map goes to the desk, which answers when the map is stored, even if the client has hung
/// up by then. If the client hangs up earlier, the map is dropped.
class MapUpload final : public WorkerUpload {
 public:
  static constexpr std::size_t kPending = 256 * 1024, kStored = 256 * 1024;
  static constexpr std::size_t kTogether =
      64 * 1024;  // the least bytes of a job, except at the beginning and the end
  static constexpr std::size_t kWithoutRoom = 24u << 20;

  MapUpload(const Visit& visit, MapUploadOptions options, std::shared_ptr<Flow> flow, loop::Workers& workers,
            std::shared_ptr<UploadBudget> budget);

 private:
  class State;
};

}  // namespace adit::intake
