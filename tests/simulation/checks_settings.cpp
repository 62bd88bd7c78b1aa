// NotCut: saved settings do not cut connections.
#include <cstdint>
#include <map>
#include <string>

#include "icd/sentence.hpp"
#include "simulation/checks.hpp"

namespace adit::simulation {
namespace {

/// The gateway was told to end, or restarts for another reason than settings. Until it listens again, that
/// may cut connections. The end of a process also cuts the connections that were opened meanwhile.
bool ends_the_gateway(const Event& event) {
  const bool restarts = event.kind == Kind::Said &&
                        (event.text.contains("restarting") || event.text.contains("listening again"));
  return event.kind == Kind::Stops || event.kind == Kind::Dies || event.kind == Kind::Ended || restarts;
}

/// The box cut the connection, or answered that it stops; the client did not.
bool is_sent_away(const Event& event) {
  if (event.kind == Kind::Gone) return event.text == "cut" || event.text == "reset";
  return event.kind == Kind::Answered && event.status == 503 && event.text.contains("is stopping");
}

}  // namespace

void not_cut(const Evidence& evidence, Broken& broken) {
  std::map<std::uint64_t, bool> asking;  // requests in flight, and whether settings were saved since
  double saved = 0;
  bool is_ending = false;
  for (const Event& event : evidence.events) {
    if (ends_the_gateway(event)) {
      asking.clear();
      is_ending = true;
    }
    if (event.kind == Kind::Said && event.text.contains("listening address")) is_ending = false;
    if (event.kind == Kind::Invoke) asking[event.request] = false;
    if (event.kind == Kind::Whole && !event.text.empty())
      asking.erase(event.request);                                // the client ends its direction
    if (event.kind == Kind::Stalls) asking.erase(event.request);  // stalled requests have a timeout
    if (event.kind == Kind::Saved && !is_ending) {
      saved = event.at;
      for (auto& [request, met] : asking) met = true;
    }
    if (event.kind != Kind::Gone && event.kind != Kind::Answered) continue;
    const auto asked = asking.extract(event.request);
    if (!asked || !asked.mapped() || !is_sent_away(event)) continue;
    broken.push_back(icd::sentence("NotCut: ", event.what, " ", event.serial, " of ", event.who,
                                   " was cut at ", event.at, ", after settings were saved at ", saved));
  }
}

}  // namespace adit::simulation
