#pragma once

#include <cstddef>
#include <memory>
#include <set>

#include "icd/status.hpp"
#include "intake/server.hpp"

namespace adit::intake {

/// The most values of a small document (codec::Limits): 25 MiB at worst.
inline constexpr std::size_t kSmallValues = 100'000;

/// Receives the body of a message. It can be rejected before the body is whole.
class Upload : public BodySink {
 public:
  /// All uploads that are not over. For the loop only.
  using UnderWay = std::set<Upload*>;

  explicit Upload(std::shared_ptr<UnderWay> under_way) : under_way_(std::move(under_way)) {
    under_way_->insert(this);
  }
  ~Upload() override { under_way_->erase(this); }
  Upload(const Upload&) = delete;
  Upload& operator=(const Upload&) = delete;

  /// Rejects the message, unless the desk has it and will answer it.
  virtual void turn_away(const icd::Refusal& refusal) = 0;

 private:
  std::shared_ptr<UnderWay> under_way_;
};

}  // namespace adit::intake
