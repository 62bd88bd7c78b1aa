// Starts and SettingsKept, and what the checks know of the disk.
#include "icd/sentence.hpp"
#include "simulation/checks.hpp"

namespace adit::simulation {

void starts(const Evidence& evidence, Broken& broken) {
  for (const Event& event : evidence.events) {
    if (event.kind == Kind::Fails)
      broken.push_back(icd::sentence("Starts: life ", event.life, " did not begin, at ", event.at));
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
      broken.push_back(icd::sentence("SettingsKept: life ", event.life,
                                     " begins with settings of before the ones that an operator saved"));
    last = event.who;
    may_be = {last};
  }
}

void DiskFaultsSeen::add(const Event& event) {
  if (event.kind == Kind::Begins) {
    this_life_ = on_;
  } else if (event.kind == Kind::Mended) {
    on_.erase(event.who);
    last_ = event.at;
  } else if (event.kind == Kind::Fault && event.actor == Actor::Disk) {
    on_.insert(event.who);
    this_life_.insert(event.who);
  }
}

bool DiskFaultsSeen::forgets_at(const Event& event) const {
  return (event.kind == Kind::Begins || event.kind == Kind::Saved) && in_this_life("RuntimeFull");
}

bool DiskFaultsSeen::within(double seconds, double now) const {
  return !on_.empty() || now - last_ < seconds;
}

}  // namespace adit::simulation
