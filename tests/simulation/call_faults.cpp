#include "simulation/call_faults.hpp"

#include <algorithm>
#include <cerrno>
#include <utility>

#include "simulation/world.hpp"

namespace adit::simulation {
namespace {

constexpr const char* kNames[] = {"Open fails", "List fails",   "Read fails", "Short reads",
                                  "Map fails",  "Status fails", "Write fails"};
constexpr double kLongest = 15;                // seconds
constexpr std::uint64_t kAll = 1'000'000'000;  // calls
/// Of the runtime directory. Faults do not hit the sessions, which stay valid over a power cut.
constexpr const char* kQueues[] = {"runtime/journal", "runtime/waiting", "runtime/rejected"};

bool is_in(const std::string& name, bool in_memory) {
  if (!in_memory) return name.starts_with("state");
  return std::ranges::any_of(kQueues, [&](const char* each) { return name.starts_with(each); });
}

}  // namespace

CallFaults::CallFaults(World& world) : world_(world), random_(world.random("calls")) {}

void CallFaults::plan(double trouble_for) {
  trouble_for_ = trouble_for;
  if (!random_.chance(0.25)) return;
  for (std::uint64_t left = 1 + random_.uniform_index(3); left > 0; --left) {
    const auto call = static_cast<Call>(random_.uniform_index(static_cast<std::uint64_t>(Call::End)));
    const bool runs_out = call == Call::Map || (call == Call::Open && random_.chance(0.5)) ||
                          (call == Call::List && random_.chance(0.5));
    Fault fault{.call = call,
                .in_memory = random_.chance(0.5),
                .at_start = random_.chance(0.5),
                .number = !runs_out           ? EIO
                          : call == Call::Map ? ENOMEM
                                              : EMFILE,
                .begins = random_.uniform(0, trouble_for),
                .lasts = random_.uniform(0.1, kLongest),
                .odds = random_.chance(0.5) ? 1 : random_.uniform(0.05, 0.5),
                .most = random_.chance(0.3) ? 1 + random_.uniform_index(3) : kAll,
                .random = world_.random("call " + std::to_string(left))};
    fault.name = std::to_string(left) + ". " + kNames[static_cast<int>(call)] +
                 (fault.in_memory ? kInRuntime : " in state");
    names_.append("; ").append(fault.name);
    if (world_.omits(fault.name)) continue;
    if (fault.at_start) ends_.push_back(fault.begins);
    faults_.push_back(std::move(fault));
  }
  for (Fault& fault : faults_) {
    if (!fault.at_start) world_.after(seconds(fault.begins), [this, &fault] { begin(fault); });
  }
}

void CallFaults::begin(Fault& fault) {
  if (world_.time() >= trouble_for_) return;
  fault.is_on = fault.was_on = true;
  world_.note({.actor = Actor::Disk, .kind = Kind::Fault, .what = "begins", .who = fault.name});
  const double lasts = std::min(fault.lasts, trouble_for_ - world_.time());
  world_.after(seconds(lasts), [this, &fault] { end(fault); });
}

void CallFaults::end(Fault& fault) {
  if (!std::exchange(fault.is_on, false)) return;
  world_.note({.actor = Actor::Disk, .kind = Kind::Mended, .what = "", .who = fault.name});
}

void CallFaults::process_begins() {
  for (Fault& fault : faults_) {
    if (fault.at_start && !fault.was_on && world_.time() >= fault.begins) begin(fault);
  }
}

CallFaults::Fault* CallFaults::hit(Call call, const std::string& name) {
  for (Fault& fault : faults_) {
    if (!fault.is_on || fault.call != call || !is_in(name, fault.in_memory)) continue;
    if (!fault.random.chance(fault.odds)) continue;
    if (--fault.most == 0) end(fault);
    return &fault;
  }
  return nullptr;
}

int CallFaults::error(Call call, const std::string& name) {
  const Fault* const fault = hit(call, name);
  return fault == nullptr ? 0 : fault->number;
}

std::optional<std::size_t> CallFaults::cut(Call call, const std::string& name, std::size_t size) {
  Fault* const fault = hit(call, name);
  if (fault == nullptr) return std::nullopt;
  return fault->random.chance(0.5) ? 0 : fault->random.uniform_index(size);
}

}  // namespace adit::simulation
