#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "api/updates.hpp"
#include "loop/workers.hpp"

namespace adit::admin {

/// A bundle that is written as it comes, by the writer: a slow disk is back-pressure to whoever sends it, and
/// never holds up the loop.
class UpdateUpload final : public api::Upload {
 public:
  /// Pieces are written together, and whoever sends them waits where so much is not written yet.
  static constexpr std::size_t kTogether = 256 << 10;

  /// What it needs to know of whoever begins it. All but `file` is called on the loop.
  struct Ends {
    std::string part, whole;                    // the paths while it comes, and once it is there
    std::uint64_t size = 0;                     // that was announced
    std::function<void()> resume;               // more may come
    std::function<icd::Checked<void>()> asked;  // it is whole: asks for the installation
    std::function<void()> over;                 // nothing of it is left to do
  };
  /// Refused where the file cannot be made. `writer` outlives this.
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
