#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "api/covered_map.hpp"
#include "loop/workers.hpp"

namespace adit::forward {

/// Counts the covered area on request. A worker counts and gives way to messages.
class CoveredCount final : public api::CoveredMap {
 public:
  static constexpr std::size_t kMostAskers = 256;

  /// Both outlive this.
  CoveredCount(loop::Workers& workers, const picture::Mosaic& mosaic) : workers_(workers), mosaic_(mosaic) {}

  void covered(Done done) override;

 private:
  struct Job;
  void pump();
  void counted(const Job& job);

  loop::Workers& workers_;
  const picture::Mosaic& mosaic_;
  std::vector<Done> askers_;  // of the next count
  bool is_counting_ = false;
  std::shared_ptr<picture::CoveredArea> area_ = std::make_shared<picture::CoveredArea>();  // a running job's
};

}  // namespace adit::forward
