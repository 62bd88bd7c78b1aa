// Starts and SettingsKept, and the faults of the disk that the checks allow for.
#include <algorithm>

#include "icd/sentence.hpp"
#include "simulation/call_faults.hpp"
#include "simulation/checks.hpp"

namespace adit::simulation {
namespace {

bool is_of_runtime(const std::string& fault) {
  return fault == "RuntimeFull" || fault.ends_with(CallFaults::kInRuntime);
}

}  // namespace

void starts(const Evidence& evidence, Broken& broken) {
  for (const Event& event : evidence.events) {
    if (event.kind == Kind::Fails)
      broken.push_back(icd::sentence("Starts: process ", event.process, " did not start, at ", event.at));
  }
}

void settings_kept(const Evidence& evidence, Broken& broken) {
  std::set<std::string> may_be = {""};
  std::string last;
  for (const Event& event : evidence.events) {
    if (event.kind == Kind::Written) {
      last = event.who;
      may_be.insert(last);
    }
    if (event.kind == Kind::Saved) may_be = {last};
    if (event.kind != Kind::Serves) continue;
    if (!may_be.contains(event.who))
      broken.push_back(icd::sentence("SettingsKept: process ", event.process,
                                     " begins with older settings than those that an operator saved"));
    last = event.who;
    may_be = {last};
  }
}

void DiskFaultsSeen::add(const Event& event) {
  if (event.kind == Kind::Begins) {
    forgets_ = std::ranges::any_of(on_, is_of_runtime);
  } else if (event.kind == Kind::Mended) {
    on_.erase(event.who);
    last_ = event.at;
  } else if (event.kind == Kind::Fault && event.actor == Actor::Disk) {
    on_.insert(event.who);
    forgets_ = forgets_ || is_of_runtime(event.who);
  }
}

bool DiskFaultsSeen::forgets_at(const Event& event) const {
  return (event.kind == Kind::Begins || event.kind == Kind::Saved) && forgets_;
}

bool DiskFaultsSeen::within(double seconds, double now) const {
  return !on_.empty() || now - last_ < seconds;
}

}  // namespace adit::simulation
