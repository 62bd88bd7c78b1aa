#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <vector>

#include "api/kept_runs.hpp"
#include "archive/record_kinds.hpp"

namespace adit::archive {

/// The plots of a run, with a sample every kSpacing seconds. At kMost samples every second one is dropped,
/// and the spacing doubles. The event count of a dropped sample is added to the next one.
class Samples {
 public:
  static constexpr double kSpacing = 2;       // seconds
  static constexpr std::size_t kMost = 3600;  // two hours at first
  static constexpr double kEarly = 0.5;       // seconds of tolerance, because ticks jitter
  static constexpr std::size_t kMostSteps = 2000;

  /// Whether a sample is due at that time.
  bool wants(api::Time at) const { return samples_.empty() || at >= samples_.back().at + spacing_ - kEarly; }
  /// Ignores a sample that is not later than the last one.
  void add(Sample sample);
  /// Beyond kMostSteps the oldest is dropped.
  void add(api::AttentionStep step);
  void clear() { *this = Samples(); }
  /// Call if the time of day was advanced by `seconds`.
  void move(double seconds);

  api::History since(api::Time since) const;

 private:
  void thin();

  double spacing_ = kSpacing;
  std::deque<Sample> samples_;  // oldest first
  std::deque<api::AttentionStep> steps_;
};

/// The present needs for attention.
class Attention {
 public:
  static constexpr std::size_t kMost = 100;  // at the same time

  /// Returns the changes since the last look.
  std::vector<api::AttentionStep> look(const std::vector<std::string>& sentences, api::Time now);
  /// `steps`: from before a restart. Needs that had not ended continue.
  void go_on(const std::vector<api::AttentionStep>& steps);
  void clear() { *this = Attention(); }

 private:
  std::vector<std::string> shown_;
};

}  // namespace adit::archive
