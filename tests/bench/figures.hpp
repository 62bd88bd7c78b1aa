#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "client.hpp"

namespace adit::bench {

/// What was measured on one way to the Command Post.
struct Path {
  std::string name;
  std::vector<Clock::duration> took;  // one for each message
  std::chrono::nanoseconds cpu{};     // of the program in between, over all of them
};

/// Microseconds that `percent` of the times do not exceed (nearest rank); 0 where there are none.
double percentile(std::vector<Clock::duration> times, int percent);

/// The figures of all ways, for a person. `paths` begins with the way without anything in between.
std::string table(const std::vector<Path>& paths);
/// One line of the same table.
std::string flush_line(const std::string& name, const std::vector<Clock::duration>& took);

/// What a report by `ours` takes more than by the slower of the other proxies, with the target beside it, and
/// the ratios. "" where there is nothing to compare.
std::string comparison(const std::vector<Path>& paths, const std::string& ours);

/// The CPU time of `ours` as a ratio to that of each of the others, in one line.
std::string cpu_comparison(const std::vector<Path>& paths, const std::string& ours);

}  // namespace adit::bench
