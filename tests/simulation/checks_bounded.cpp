// Bounded: limits of memory, files and lists, under load and at rest.
#include <algorithm>
#include <ranges>
#include <string>

#include "icd/sentence.hpp"
#include "simulation/call_faults.hpp"
#include "simulation/checks.hpp"

namespace adit::simulation {
namespace {

constexpr std::uint64_t kMiB = 1u << 20;
/// The log in use, a spare one, and one for each fault of the disk, because a fault begins another log,
/// until there are two snapshots. Plus all other files of the state directory.
constexpr std::uint64_t kStateFolder = 26 * kMiB;
/// Size of a damaged ledger that was put aside.
constexpr std::uint64_t kDamaged = 5 * kMiB;
/// The journal in use, and the compacted one that is written beside it.
constexpr std::uint64_t kJournal = 5 * kMiB / 2;
/// The sessions and the rejected messages of a run, of which up to nine are large.
constexpr std::uint64_t kBeside = 16 * kMiB;

struct Most {
  const char* list;
  std::size_t rows;
};
constexpr Most kLists[] = {{"activities", 200}, {"refusals", 50}, {"reports", 200}, {"rejected", 100}};

class Looking {
 public:
  /// `damaged`: number of damaged ledgers that were put aside.
  Looking(const Reading& reading, std::uint64_t damaged, Broken& broken)
      : reading_(reading), state_(kStateFolder + damaged * kDamaged), broken_(broken) {}

  void at(const char* what, std::uint64_t bytes, std::uint64_t most) {
    if (bytes > most)
      broken_.push_back(
          icd::sentence("Bounded: at ", reading_.at, " ", what, ": ", bytes, ", at most ", most));
  }
  void at_lists() {
    for (const auto& [list, rows] : kLists) at(list, reading_.view.at(list).size(), rows);
  }
  /// `compacts`: no fault kept the journal from being compacted.
  void at_files(bool compacts) {
    at("bytes in the state folder", reading_.stored.state, state_);
    if (compacts) at("bytes of the journal", reading_.stored.journal, kJournal);
    at("bytes in the runtime folder", reading_.stored.others, kBeside);
  }
  void at_rest() { at("bytes of maps at rest", reading_.stored.waiting, 0); }

 private:
  const Reading& reading_;
  std::uint64_t state_;
  Broken& broken_;
};

/// The number of damaged ledgers after the first `events` events.
std::uint64_t damaged_after(std::size_t events, const Evidence& evidence) {
  const auto was_damaged = [](const Event& event) {
    return event.kind == Kind::Said && event.text.contains("The ledger was damaged");
  };
  return static_cast<std::uint64_t>(
      std::ranges::count_if(evidence.events | std::views::take(events), was_damaged));
}

bool is_in_runtime(const Event& event) {
  return event.kind == Kind::Fault && event.who.ends_with(CallFaults::kInRuntime);
}

bool nothing_waits(const nlohmann::json& view) {
  return std::ranges::all_of(view.at("activities"), [](const auto& row) { return row.at("queued") == 0; });
}

}  // namespace

void bounded(const Evidence& evidence, Broken& broken) {
  double changed = 1e9;  // when other settings were saved
  for (const Event& event : evidence.events) {
    if (event.kind == Kind::Written) changed = std::min(changed, event.at);
    if (event.kind == Kind::Forbidden && event.what == kTooMuch)
      broken.push_back(icd::sentence("Bounded: at ", event.at, " ", event.text));
  }
  for (const Reading& reading : evidence.readings) {
    Looking looking(reading, damaged_after(reading.heard, evidence), broken);
    looking.at_lists();
    looking.at_files(!std::ranges::any_of(evidence.events | std::views::take(reading.heard), is_in_runtime));
    if (reading.at < changed)
      looking.at("bytes of maps", reading.view.at("queued_bytes"), evidence.most_map_bytes);
  }
  if (evidence.readings.empty() || !nothing_waits(evidence.readings.back().view)) return;
  // A start that cannot list the directory leaves unfinished files, and logs that.
  if (std::ranges::any_of(evidence.events, is_in_runtime)) return;
  Looking(evidence.readings.back(), 0, broken).at_rest();
}

}  // namespace adit::simulation
