#include "simulation/counting.hpp"

#include <algorithm>
#include <chrono>

namespace adit::simulation {
namespace {

constexpr std::chrono::milliseconds kLeast{950};  // "approximately" one a second

}  // namespace

bool Counting::is_too_soon(const std::string& path, const WhenLeft& left) const {
  const auto last = last_.find(path);
  if (last == last_.end()) return false;
  return (what_ == What::LastBytes ? left.last : left.first) - last->second < kLeast;
}

void Counting::count(const std::string& path, const WhenLeft& left, loop::Instant answered) {
  loop::Instant& last = last_[path];
  last = std::max(last, what_ == What::Starts ? left.first : what_ == What::LastBytes ? left.last : answered);
}

}  // namespace adit::simulation
