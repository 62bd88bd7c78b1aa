#pragma once

#include <chrono>

namespace adit::pace {

/// How long to wait before the next try after failures: doubling from `first` to `most`, each with up to a
/// quarter more by chance so that many do not come back at once.
class Backoff {
 public:
  Backoff(std::chrono::milliseconds first, std::chrono::milliseconds most)
      : first_(first), most_(most), wait_(first) {}

  /// `random`: uniform in [0, 1).
  std::chrono::nanoseconds failed(double random);
  void succeeded() { wait_ = first_; }

 private:
  std::chrono::milliseconds first_, most_, wait_;
};

}  // namespace adit::pace
