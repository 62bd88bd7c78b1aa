#include "simulation/tally.hpp"

#include <cstdio>

namespace adit::simulation {

void Tally::add(const Outcome& outcome) {
  ++runs;
  events += outcome.steps;
  faults += outcome.faults;
  hours += outcome.seconds / 3600;
}

void Tally::add(const Tally& other) {
  runs += other.runs;
  events += other.events;
  faults += other.faults;
  failed += other.failed;
  hours += other.hours;
  cpu += other.cpu;
}

std::string Tally::sentence(std::uint64_t first_seed) const {
  char text[256];
  std::snprintf(
      text, sizeof text,
      "%llu runs from seed %llu: %.2f simulated hours, %llu events, %llu faults, %.1f s of CPU, %llu failed",
      static_cast<unsigned long long>(runs), static_cast<unsigned long long>(first_seed), hours,
      static_cast<unsigned long long>(events), static_cast<unsigned long long>(faults), cpu,
      static_cast<unsigned long long>(failed));
  return text;
}

}  // namespace adit::simulation
