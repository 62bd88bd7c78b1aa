#include "gateway/crowding.hpp"

#include <algorithm>

namespace adit::gateway {

void Crowding::ended(intake::Ended why, const std::string& address, loop::Instant now) {
  Kind& kind = kinds_[static_cast<std::size_t>(why)];
  if (now - kind.last >= kRecent) kind.by_address.clear();
  kind.last = now;
  ++kind.count;
  if (kind.by_address.size() < kMostAddresses || kind.by_address.contains(address))
    ++kind.by_address[address];
}

std::vector<alarms::CrowdFact> Crowding::crowds(loop::Instant now) const {
  using Is = alarms::CrowdFact::Is;
  std::vector<alarms::CrowdFact> crowds;
  for (const intake::Ended why : kTold) {
    if (at(why).count == 0 || now - at(why).last >= kRecent) continue;
    const Is is = why == intake::Ended::NoRoom       ? Is::NoRoom
                  : why == intake::Ended::WrongToken ? Is::WrongToken
                                                     : Is::Unauthenticated;
    crowds.push_back({is, most_of(why)});
  }
  return crowds;
}

std::vector<Crowding::Line> Crowding::to_log(loop::Instant now) {
  std::vector<Line> lines;
  for (const intake::Ended why : kTold) {
    Kind& kind = kinds_[static_cast<std::size_t>(why)];
    if (kind.count == kind.logged || now < kind.log_at) continue;
    lines.push_back({sentence(why), kind.count - kind.logged});
    kind.logged = kind.count;
    kind.log_at = now + kLogEvery;
  }
  return lines;
}

const std::string& Crowding::most_of(intake::Ended why) const {
  return std::ranges::max_element(at(why).by_address, {}, [](const auto& each) { return each.second; })
      ->first;
}

std::string Crowding::sentence(intake::Ended why) const {
  const std::string& most = most_of(why);
  if (why == intake::Ended::NoRoom) {
    return "requests rejected with 503, most from " + most +
           ": too many requests at once (team.connections, team.connections_per_address)";
  }
  if (why == intake::Ended::WrongToken) {
    return "requests with wrong tokens, most from " + most +
           ": robots with an old token, or an attacker; right tokens are accepted";
  }
  return "too many unauthenticated connections, most from " + most + ": the oldest are closed for new ones";
}

}  // namespace adit::gateway
