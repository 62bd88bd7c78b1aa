#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <vector>

#include "api/kept_runs.hpp"
#include "archive/said.hpp"

namespace adit::archive {

/// The plots of a run: a sample each kSpacing. Where there are kMost of them, every other one goes, and new
/// ones come half as often. A count of events is that of the time since the sample before, and none is lost.
class Samples {
 public:
  static constexpr double kSpacing = 2;       // seconds
  static constexpr std::size_t kMost = 3600;  // two hours at first
  static constexpr double kEarly = 0.5;       // seconds: what comes each second comes not quite so
  static constexpr std::size_t kMostSteps = 2000;

  /// Whether one is wanted at that time.
  bool wants(api::Time at) const { return samples_.empty() || at >= samples_.back().at + spacing_ - kEarly; }
  /// Of a time that is later than the last one; others are passed over.
  void add(Sample sample);
  /// Beyond kMostSteps the oldest goes.
  void add(api::AttentionStep step);
  void clear() { *this = Samples(); }
  /// The time of day was set ahead by so many seconds.
  void move(double seconds);

  bool empty() const { return samples_.empty() && steps_.empty(); }
  api::History since(api::Time since) const;

 private:
  void thin();

  double spacing_ = kSpacing;
  std::deque<Sample> samples_;  // oldest first
  std::deque<api::AttentionStep> steps_;
};

/// What needs the operator, as it comes and goes.
class Attention {
 public:
  static constexpr std::size_t kMost = 100;  // at once

  /// What came and what went since the last look.
  std::vector<api::AttentionStep> look(const std::vector<std::string>& sentences, api::Time now);
  /// `steps`: of the life before. What had come and not gone by then still stands.
  void go_on(const std::vector<api::AttentionStep>& steps);
  void clear() { *this = Attention(); }

 private:
  std::vector<std::string> shown_;
};

}  // namespace adit::archive
