#pragma once

#include <memory>
#include <vector>

#include "codec/body_decoder.hpp"
#include "icd/rules.hpp"
#include "intake/visit.hpp"
#include "loop/workers.hpp"

namespace adit::intake {

/// How much all maps under way together may have brought, so that many at once cannot use up the memory. For
/// the loop alone.
class UploadBudget {
 public:
  explicit UploadBudget(std::size_t bytes) : left_(bytes) {}
  bool take(std::size_t bytes) {
    if (bytes > left_) return false;
    left_ -= bytes;
    return true;
  }
  void give_back(std::size_t bytes) { left_ += bytes; }

 private:
  std::size_t left_;
};

struct MapUploadOptions {
  codec::BodyKind kind;
  icd::Rules rules;
  std::size_t most_bytes = 0;  // of the body
};

/// Takes a map. Its body is decoded on a worker as it arrives, one piece of work at a time; while more than
/// kPending waits for the worker, the client is made to wait.
///
/// A body that is compressed as a whole may grow a thousandfold. It is held as it came until it is whole, so
/// that the budget knows what is held, and no more than one for each worker is ever inflated.
class MapUpload final : public Exchange {
 public:
  static constexpr std::size_t kPending = 256 * 1024;

  MapUpload(Visit visit, MapUploadOptions options, std::shared_ptr<Flow> flow, loop::Workers& workers,
            std::shared_ptr<UploadBudget> budget);
  ~MapUpload() override;
  MapUpload(const MapUpload&) = delete;
  MapUpload& operator=(const MapUpload&) = delete;

  bool on_body(std::span<const std::uint8_t> piece) override;
  void on_end() override;
  void on_gone() override;

 private:
  class State;
  std::shared_ptr<State> state_;
};

}  // namespace adit::intake
