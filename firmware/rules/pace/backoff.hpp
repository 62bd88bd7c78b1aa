#pragma once

#include <chrono>

namespace adit::pace {

/// The pause before the next try. It doubles from `first` to `most` with each failure. Each pause is up to a
/// quarter longer by chance, so that many clients do not retry at the same time.
class Backoff {
 public:
  Backoff(std::chrono::milliseconds first, std::chrono::milliseconds most)
      : first_(first), most_(most), wait_(first) {}

  /// Returns the pause. `random`: uniform in [0, 1).
  std::chrono::nanoseconds failed(double random);
  void succeeded() { wait_ = first_; }

 private:
  std::chrono::milliseconds first_, most_, wait_;
};

}  // namespace adit::pace
