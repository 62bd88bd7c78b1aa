#include "dispatch/runs.hpp"

#include <algorithm>
#include <utility>

namespace adit::dispatch {

void Runs::open(std::vector<Run> all, std::int64_t latest) {
  runs_.clear();
  for (Run& run : all) runs_[run.number] = std::move(run);
  if (runs_.empty() || runs_.rbegin()->first < latest) runs_[latest] = {.number = latest};
  // The last run is the present one if it has no turn.
  present_ = runs_.rbegin()->first;
  if (runs_.at(present_).turn == 0) return take_up(present_);
  present_ = std::ranges::max_element(runs_, {}, [](const auto& item) { return item.second.place(); })->first;
}

const Run* Runs::find(std::int64_t number) const {
  const auto found = runs_.find(number);
  return found == runs_.end() ? nullptr : &found->second;
}

const Run* Runs::latest(const std::function<bool(const Run&)>& fits) const {
  const Run* found = nullptr;
  for (const auto& [number, run] : runs_) {
    if (number == present_ || !fits(run)) continue;
    if (found == nullptr || run.place() > found->place()) found = &run;
  }
  return found;
}

const Run* Runs::at_post(const std::string& post) const {
  return latest([&post](const Run& run) { return run.post == post; });
}

std::int64_t Runs::next_turn() const {
  std::int64_t last = 0;
  for (const auto& [number, run] : runs_) last = std::max(last, run.place());
  return last + 1;
}

void Runs::begin(Run run) {
  run.number = next_number();
  run.turn = next_turn();
  present_ = run.number;
  runs_[present_] = std::move(run);
}

void Runs::take_up(std::int64_t number) {
  runs_.at(number).turn = next_turn();
  present_ = number;
}

bool Runs::is_at(std::int64_t number, const std::string& post) const {
  const Run* const run = find(number);
  return run == nullptr || run->post.empty() || run->post == post;
}

std::vector<std::int64_t> Runs::maybe(std::int64_t number) const {
  std::vector<std::int64_t> numbers;
  // The last condition ends a damaged chain.
  for (const Run* run = find(number); run != nullptr;) {
    numbers.push_back(run->number);
    run = run->may_be != 0 && run->may_be < run->number ? find(run->may_be) : nullptr;
  }
  return numbers;
}

const std::string& Runs::name_trouble() const {
  for (const std::int64_t number : maybe_present()) {
    const Run& run = runs_.at(number);
    if (!run.name_trouble.empty()) return run.name_trouble;
  }
  return present().name_trouble;
}

bool Runs::may_be(std::int64_t number, std::int64_t other) const {
  const auto numbers = maybe(number);
  return std::ranges::find(numbers, other) != numbers.end();
}

const Run& Runs::is_not(std::int64_t number) {
  Run* later = &present();
  while (later->may_be != number) later = &runs_.at(later->may_be);
  later->may_be = 0;
  return *later;
}

}  // namespace adit::dispatch
