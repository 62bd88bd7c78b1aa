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

std::vector<std::string> Crowding::attention(loop::Instant now) const {
  std::vector<std::string> sentences;
  for (const intake::Ended why : kTold) {
    if (at(why).count > 0 && now - at(why).last < kRecent) sentences.push_back(sentence(why));
  }
  return sentences;
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

std::string Crowding::sentence(intake::Ended why) const {
  const auto most =
      std::ranges::max_element(at(why).by_address, {}, [](const auto& each) { return each.second; });
  if (why == intake::Ended::NoRoom) {
    return "requests are answered 503, most of " + most->first +
           ": too many are under way at once (team.connections, team.connections_per_address)";
  }
  if (why == intake::Ended::WrongToken) {
    return "requests show wrong tokens, most of " + most->first +
           ": robots with an old one, or somebody who guesses; right ones are let in";
  }
  return "too many connections are open without a token, most of " + most->first +
         ": the oldest are ended for new ones";
}

}  // namespace adit::gateway
