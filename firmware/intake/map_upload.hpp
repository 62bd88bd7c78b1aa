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
  std::size_t most_bytes = 0;                  // of the body
  std::shared_ptr<UploadBudget> without_room;  // for what is held because it cannot be stored
};

/// Takes a map. A worker decodes its body as it arrives, one piece of work at a time; while more than
/// kPending waits for the worker, the client has to wait. Decoded data is stored kStored bytes and more at a
/// time; if as much again is decoded before that is stored, the worker rests. So no large map is in memory as
/// a whole. Of a grid that says before its data that it is one, as most do, the gzipped cells are what is
/// decoded and stored (codec::PressedCells): when its last byte is there, it is as good as packed.
///
/// A body that is compressed as a whole may grow a thousandfold, and is decoded by little more than kStored
/// at a time. Its decoded size counts in the budget. If it cannot be stored, it is held in memory until it
/// can be judged: kWithoutRoom of all such maps together; a map that would need more is refused.
///
/// Once whole and checked it is the desk's, which answers when it is kept, even if the client has hung up by
/// then. If the client hangs up before, the map is dropped.
class MapUpload final : public WorkerUpload {
 public:
  static constexpr std::size_t kPending = 256 * 1024, kStored = 256 * 1024;
  static constexpr std::size_t kTogether =
      64 * 1024;  // is decoded at once, but for the beginning and the end
  static constexpr std::size_t kWithoutRoom = 24u << 20;

  MapUpload(Visit visit, MapUploadOptions options, std::shared_ptr<Flow> flow, loop::Workers& workers,
            std::shared_ptr<UploadBudget> budget, std::shared_ptr<UnderWay> under_way);

 private:
  class State;
};

}  // namespace adit::intake
