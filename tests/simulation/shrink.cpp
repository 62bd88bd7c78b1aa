#include "simulation/shrink.hpp"

#include <algorithm>

#include "simulation/run.hpp"

namespace adit::simulation {
namespace {

class Shrinking {
 public:
  Shrinking(std::uint64_t seed, Omissions from, std::string broken, int most_plays)
      : seed_(seed), without_(std::move(from)), broken_(std::move(broken)), plays_left_(most_plays) {}

  Omissions result() {
    for (const auto& [actor, actions] : actions()) try_without_all(actor);
    for (bool smaller = true; smaller && plays_left_ > 0;) {
      smaller = false;
      for (const auto& [actor, actions] : actions()) smaller = try_ranges(actor, actions) || smaller;
    }
    return without_;
  }

 private:
  Actions actions() const { return play({.seed = seed_, .without = without_}).actions; }

  /// Keeps `next` where the same is broken in it.
  bool still_breaks(Omissions next) {
    if (plays_left_-- <= 0) return false;
    const auto broken = play({.seed = seed_, .without = next}).broken;
    const bool breaks = std::ranges::find(broken, broken_) != broken.end();
    if (breaks) without_ = std::move(next);
    return breaks;
  }

  void try_without_all(const std::string& actor) {
    Omissions next = without_;
    next.add_all(actor);
    still_breaks(std::move(next));
  }

  /// Halves, quarters and so on, down to single ones.
  bool try_ranges(const std::string& actor, std::uint64_t actions) {
    bool smaller = false;
    for (std::uint64_t size = (actions + 1) / 2; size > 0 && plays_left_ > 0;
         size = size == 1 ? 0 : (size + 1) / 2) {
      for (std::uint64_t first = 1; first <= actions; first += size)
        smaller = try_range(actor, first, std::min(first + size - 1, actions)) || smaller;
    }
    return smaller;
  }

  bool try_range(const std::string& actor, std::uint64_t first, std::uint64_t last) {
    while (first <= last && without_.has(actor, first)) ++first;
    while (first <= last && without_.has(actor, last)) --last;
    if (first > last) return false;
    Omissions next = without_;
    next.add(actor, first, last);
    return still_breaks(std::move(next));
  }

  const std::uint64_t seed_;
  Omissions without_;
  const std::string broken_;
  int plays_left_;
};

}  // namespace

Omissions shrunk(std::uint64_t seed, const Omissions& from, const std::string& broken, int most_plays) {
  return Shrinking(seed, from, broken, most_plays).result();
}

}  // namespace adit::simulation
