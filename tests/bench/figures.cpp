#include "figures.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

namespace adit::bench {
namespace {

/// The target holds where the disk flushes in about 0.1 ms: a report must be on it before it leaves.
struct Target {
  int percent;
  int most_us;  // more than the slower of the proxies
};
constexpr std::array kTargets = {Target{50, 150}, Target{99, 500}};

/// printf's words for one line of text.
template <class... Values>
std::string line(const char* form, Values... values) {
  std::array<char, 160> text{};
  const int size = std::snprintf(text.data(), text.size(), form, values...);
  return {text.data(), static_cast<std::size_t>(std::clamp<int>(size, 0, text.size() - 1))};
}

double microseconds(Clock::duration time) {
  return std::chrono::duration<double, std::micro>(time).count();
}

}  // namespace

double percentile(std::vector<Clock::duration> times, int percent) {
  if (times.empty()) return 0;
  const auto rank = (times.size() * static_cast<std::size_t>(percent) + 99) / 100 - 1;
  std::ranges::nth_element(times, times.begin() + static_cast<std::ptrdiff_t>(rank));
  return microseconds(times[rank]);
}

std::string table(const std::vector<Path>& paths) {
  std::string text = line("%-15s %8s %8s %8s   %9s %9s %9s   %9s\n", "us", "p50", "p90", "p99", "added p50",
                          "p90", "p99", "CPU each");
  const Path& direct = paths.front();
  for (const Path& path : paths) {
    const std::array<double, 3> whole = {percentile(path.took, 50), percentile(path.took, 90),
                                         percentile(path.took, 99)};
    text += line("%-15s %8.0f %8.0f %8.0f", path.name.c_str(), whole[0], whole[1], whole[2]);
    if (&path != &direct) {
      text += line("   %9.0f %9.0f %9.0f   %9.0f", whole[0] - percentile(direct.took, 50),
                   whole[1] - percentile(direct.took, 90), whole[2] - percentile(direct.took, 99),
                   microseconds(path.cpu) / static_cast<double>(std::max<std::size_t>(path.took.size(), 1)));
    }
    text += '\n';
  }
  return text;
}

std::string flush_line(const std::string& name, const std::vector<Clock::duration>& took) {
  return line("%-15s %8.0f %8.0f %8.0f\n", name.c_str(), percentile(took, 50), percentile(took, 90),
              percentile(took, 99));
}

std::string comparison(const std::vector<Path>& paths, const std::string& ours) {
  const auto adit = std::ranges::find(paths, ours, &Path::name);
  if (adit == paths.end()) return "";
  std::string text;
  for (const Target& target : kTargets) {
    const Path* slower = nullptr;
    double most = 0;
    for (auto path = paths.begin() + 1; path != paths.end(); ++path) {
      const double time = percentile(path->took, target.percent);
      if (path == adit || time <= most) continue;
      slower = &*path;
      most = time;
    }
    if (slower == nullptr) return "";
    const double direct = percentile(paths.front().took, target.percent);
    const double time = percentile(adit->took, target.percent);
    text += line("p%d: %s - %s: %.0f us (target: at most %d); %s / %s: %.1f", target.percent, ours.c_str(),
                 slower->name.c_str(), time - most, target.most_us, ours.c_str(), slower->name.c_str(),
                 time / most);
    if (most > direct && time > direct)
      text += line(" of the whole, %.1f of what is added", (time - direct) / (most - direct));
    text += '\n';
  }
  return text;
}

std::string cpu_comparison(const std::vector<Path>& paths, const std::string& ours) {
  const auto adit = std::ranges::find(paths, ours, &Path::name);
  if (adit == paths.end()) return "";
  std::string text = "CPU";
  for (const Path& path : paths) {
    if (path.name == ours || path.cpu.count() == 0) continue;
    text += line("; %s / %s: %.2f", ours.c_str(), path.name.c_str(),
                 static_cast<double>(adit->cpu.count()) / static_cast<double>(path.cpu.count()));
  }
  return text + '\n';
}

}  // namespace adit::bench
