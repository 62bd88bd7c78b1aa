// The files by which aditd and adit-clock speak: what the program that runs as root reads is anybody's. And
// what chronyd tells.
#include <algorithm>
#include <cmath>

#include "clock/chrony.hpp"
#include "target.hpp"

namespace adit::fuzz {
namespace {

/// Of whatever is asked for, nothing is set that nobody may ask for, nor to no time of a box.
void stays_in_bounds(const clock::Request& request) {
  constexpr double kAt = 100;  // seconds since the machine's start
  if (!clock::refusal_reason(request, kAt, {}).empty()) return;
  const double set = request.time + (kAt - request.at);
  require(set >= clock::kEarliest && set <= clock::kLatest + 60);
  require(request.at >= 0 && request.at <= kAt);
  require(request.source != clock::Source::None && request.source != clock::Source::Chip);
}

/// Whatever is asked for, chronyd is told no line but its own.
void tells_no_more(const clock::Ntp& ntp) {
  if (!ntp.is_on()) return;
  for (const clock::Source source : {clock::Source::None, clock::Source::Operator, clock::Source::Ntp}) {
    const clock::Chrony chrony = clock::chrony_for(ntp, source, "team0");
    const auto lines = std::ranges::count(chrony.configuration, '\n');
    require(lines <= 13 && chrony.configuration.size() < 400);
    require(std::ranges::count(chrony.firewall, '\n') <= 4 && std::ranges::count(chrony.firewall, '}') <= 2);
  }
}

void is_a_time(Input bytes) {
  const auto tracking = clock::read_tracking(bytes_of(bytes), 7);
  if (tracking)
    require(tracking->heard >= 0 && std::isfinite(tracking->heard) && std::isfinite(tracking->behind));
}

}  // namespace

void try_clock(Input text) {
  is_a_time(text);
  settles(text, codec::read_file<clock::Request>);
  settles(text, codec::read_file<clock::Status>);
  settles(text, codec::read_file<clock::Ntp>);
  if (const auto ntp = codec::read_file<clock::Ntp>(text)) tells_no_more(*ntp);
  if (const auto request = codec::read_file<clock::Request>(text)) stays_in_bounds(*request);
}

}  // namespace adit::fuzz
