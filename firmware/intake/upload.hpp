#pragma once

#include <cstddef>
#include <memory>
#include <set>

#include "icd/status.hpp"
#include "intake/server.hpp"

namespace adit::intake {

/// How many values a document may have that is read like any small one (codec::Limits): 25 MiB at the worst.
inline constexpr std::size_t kSmallValues = 100'000;

/// Takes the body of a message, and can be told in the middle of it that nothing more is taken.
class Upload : public BodySink {
 public:
  /// All that are under way. For the loop alone.
  using UnderWay = std::set<Upload*>;

  explicit Upload(std::shared_ptr<UnderWay> under_way) : under_way_(std::move(under_way)) {
    under_way_->insert(this);
  }
  ~Upload() override { under_way_->erase(this); }
  Upload(const Upload&) = delete;
  Upload& operator=(const Upload&) = delete;

  /// Refuses the message, unless it has gone to the desk, which answers it.
  virtual void turn_away(const icd::Refusal& refusal) = 0;

 private:
  std::shared_ptr<UnderWay> under_way_;
};

}  // namespace adit::intake
