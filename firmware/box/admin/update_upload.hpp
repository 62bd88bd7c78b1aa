#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "api/updates.hpp"
#include "loop/workers.hpp"

namespace adit::admin {

/// A bundle that the writer thread stores as it arrives. A slow disk slows the sender and never blocks the
/// loop.
class UpdateUpload final : public api::Upload {
 public:
  /// Bytes collected for one write. The sender is paused if as many are queued during a write.
  static constexpr std::size_t kTogether = 256 << 10;

  /// Data and callbacks of the caller. All but `part` and `whole` are used on the loop.
  struct Ends {
    std::string part, whole;                    // path during the upload, and afterwards
    std::uint64_t size = 0;                     // announced size
    std::function<void()> resume;               // accept more data
    std::function<icd::Checked<void>()> asked;  // the file is complete: requests the installation
    std::function<void()> over;                 // the upload is finished or abandoned
  };
  /// Error: the file cannot be created. `writer` must outlive this object.
  static icd::Checked<std::unique_ptr<UpdateUpload>> begin(loop::Writer& writer, Ends ends);
  ~UpdateUpload() override;
  UpdateUpload(const UpdateUpload&) = delete;
  UpdateUpload& operator=(const UpdateUpload&) = delete;

  bool write(std::span<const std::uint8_t> piece) override;
  void finish(std::function<void(icd::Checked<void>)> done) override;
  std::uint64_t received() const;

 private:
  class Writing;
  explicit UpdateUpload(std::shared_ptr<Writing> writing) : writing_(std::move(writing)) {}
  std::shared_ptr<Writing> writing_;  // shared with the writer's jobs
};

}  // namespace adit::admin
