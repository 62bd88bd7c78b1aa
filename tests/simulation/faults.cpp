#include "simulation/faults.hpp"

namespace adit::simulation {
namespace {

constexpr auto kKinds = static_cast<std::size_t>(Fault::End);
constexpr const char* kNames[kKinds] = {
    "LostBefore",  "LostAfter",      "CutAnswer",    "Delay",      "Silence",     "Storm",
    "PoliteStorm", "Error",          "Html",         "HugeLength", "HugeChunk",   "WrongLength",
    "Garbage",     "WrongTypes",     "Redirect",     "Between",    "Unwanted",    "TakenThrottled",
    "OddAnswer",   "ClosesAfter",    "Refused",      "Deaf",       "Mute",        "Outage",
    "StatusDown",  "ConstantClocks", "NamelessRuns", "NewRun",     "OtherSender", "AdminStop"};

}  // namespace

std::string name_of(Fault fault) {
  return kNames[static_cast<std::size_t>(fault)];
}

Faults::Faults(Random random) : random_(random), odds_(kKinds, 0.0) {
  const double odds = random_.uniform(0.05, 0.4);
  if (random_.chance(0.5)) {
    for (std::uint64_t i = random_.uniform_index(3); i > 0; --i) odds_[random_.uniform_index(kKinds)] = odds;
  } else {
    for (double& each : odds_) each = random_.chance(0.2) ? odds / 2 : 0;
  }
}

Fault Faults::of_request() {
  for (std::size_t i = 0; i <= static_cast<std::size_t>(Fault::ClosesAfter); ++i) {
    const auto fault = static_cast<Fault>(i);
    if (fault == Fault::Storm || fault == Fault::PoliteStorm) continue;
    if (odds_[i] > 0 && random_.chance(odds_[i])) return fault;
  }
  return Fault::End;
}

std::string Faults::names() const {
  std::string names;
  for (std::size_t i = 0; i < kKinds; ++i) {
    if (odds_[i] == 0) continue;
    if (!names.empty()) names += ' ';
    names += kNames[i];
  }
  return names.empty() ? "none" : names;
}

}  // namespace adit::simulation
