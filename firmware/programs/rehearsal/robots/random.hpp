#pragma once

#include <cstdint>
#include <random>

namespace adit::robots {

/// Draws that are the same on every machine for the same seed, which the distributions of <random> do not
/// promise.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// From `low` to below `high`.
  double between(double low, double high) {
    constexpr double kStep = 1.0 / static_cast<double>(1ull << 53);
    return low + (high - low) * static_cast<double>(engine_() >> 11) * kStep;
  }

  bool chance(double probability) { return between(0, 1) < probability; }

  /// From 0 to below `count`, which is above 0.
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(engine_() % count); }

  /// Bell-shaped about 0 (Irwin-Hall of four), standard deviation `sigma`.
  double noise(double sigma) {
    constexpr double kUnitSigma = 0.57735026918962576;  // of the sum of four draws from -0.5 to 0.5
    return sigma / kUnitSigma *
           (between(-0.5, 0.5) + between(-0.5, 0.5) + between(-0.5, 0.5) + between(-0.5, 0.5));
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace adit::robots
