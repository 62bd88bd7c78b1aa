#include "archive/samples.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

namespace adit::archive {
namespace {

bool has(const std::vector<std::string>& all, const std::string& one) {
  return std::ranges::find(all, one) != all.end();
}

}  // namespace

void Samples::add(Sample sample) {
  if (!samples_.empty() && sample.at <= samples_.back().at) return;
  if (samples_.size() == kMost) thin();
  samples_.push_back(std::move(sample));
}

void Samples::add(api::AttentionStep step) {
  if (steps_.size() == kMostSteps) steps_.pop_front();
  steps_.push_back(std::move(step));
}

void Samples::move(double seconds) {
  for (Sample& sample : samples_) sample.at += seconds;
  for (api::AttentionStep& step : steps_) step.at += seconds;
}

void Samples::thin() {
  std::deque<Sample> kept;
  std::uint64_t throttled = 0;
  bool keep = false;
  for (Sample& sample : samples_) {
    throttled += sample.throttled;
    keep = !keep;
    if (!keep) continue;
    sample.throttled = std::exchange(throttled, 0);
    kept.push_back(std::move(sample));
  }
  kept.back().throttled += throttled;
  samples_ = std::move(kept);
  spacing_ *= 2;
}

api::History Samples::since(api::Time since) const {
  api::History all{.spacing = spacing_};
  const auto from = std::ranges::upper_bound(samples_, since, {}, &Sample::at);
  std::set<std::string> robots;
  for (auto sample = from; sample != samples_.end(); ++sample) {
    all.at.push_back(sample->at);
    all.sent_mbit.push_back(sample->sent_mbit);
    all.queued_bytes.push_back(sample->queued_bytes);
    all.scoring_ms.push_back(sample->scoring_ms);
    all.mapping_ms.push_back(sample->mapping_ms);
    all.throttled.push_back(sample->throttled);
    for (const auto& [robot, age] : sample->map_ages) robots.insert(robot);
  }
  for (const std::string& robot : robots) {
    api::MapAges& row = all.robots.emplace_back(robot);
    for (auto sample = from; sample != samples_.end(); ++sample) {
      const auto found = std::ranges::find(sample->map_ages, robot, &std::pair<std::string, double>::first);
      row.ages.push_back(found == sample->map_ages.end() ? std::nullopt : std::optional(found->second));
    }
  }
  for (const api::AttentionStep& step : steps_) {
    if (step.at > since) all.attention.push_back(step);
  }
  return all;
}

void Attention::go_on(const std::vector<api::AttentionStep>& steps) {
  for (const api::AttentionStep& step : steps) {
    std::erase(shown_, step.sentence);
    if (step.came && shown_.size() < kMost) shown_.push_back(step.sentence);
  }
}

std::vector<api::AttentionStep> Attention::look(const std::vector<std::string>& sentences, api::Time now) {
  std::vector<api::AttentionStep> steps;
  std::vector<std::string> shown(
      sentences.begin(), sentences.begin() + static_cast<std::ptrdiff_t>(std::min(sentences.size(), kMost)));
  for (const std::string& sentence : shown_) {
    if (!has(shown, sentence)) steps.push_back({now, false, sentence});
  }
  for (const std::string& sentence : shown) {
    if (!has(shown_, sentence)) steps.push_back({now, true, sentence});
  }
  shown_ = std::move(shown);
  return steps;
}

}  // namespace adit::archive
