#include "api/clock.hpp"

#include <chrono>
#include <cmath>

#include "cli/handlers.hpp"
#include "cli/words.hpp"
#include "clock/messages.hpp"
#include "icd/sentence.hpp"
#include "icd/utc.hpp"

namespace adit::cli {
namespace {

constexpr double kAsHere = 2;  // seconds of difference that count as equal

double time_here() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

/// In the order of clock::Source.
constexpr std::string_view kSetBy[] = {"not set since boot",          "continued from the last known time",
                                       "set by the robots' stamps",   "set by the Command Post's answers",
                                       "set by the box's clock chip", "set by an operator",
                                       "set by an NTP server"};
static_assert(std::size(kSetBy) == std::size(clock::kSourceWords));

std::string text_of(const api::ClockView& view, bool /*colour*/) {
  const double ahead = view.now - time_here();
  const std::string apart =
      std::abs(ahead) <= kAsHere
          ? "the same as on this computer"
          : icd::sentence(duration(std::abs(ahead)), ahead > 0 ? " ahead of" : " behind", " this computer");
  const std::string date = icd::utc(view.now);
  std::string out = line(date.empty() ? "date unknown" : date + " UTC", ", ", apart);
  out += view.source ? line(kSetBy[static_cast<std::size_t>(*view.source)])
                     : line("Adit cannot set it: ", view.why);
  if (!view.refusal.empty()) out += line("Not set: ", view.refusal);
  if (!view.ntp.empty()) out += line(view.ntp);
  if (!view.is_set && view.managed) out += line("To set it to this computer's time: adit clock set");
  return out;
}

}  // namespace

Result<Outcome> show_clock(const Call& call) {
  return show<api::ClockView>(call, "/adit/clock", text_of,
                              [](const api::ClockView& view) { return view.is_set && view.refusal.empty(); });
}

Result<Outcome> set_clock(const Call& call) {
  return act(call,
             {.target = "/adit/clock",
              .check = "adit clock",
              .body = "{\"time\":" + std::to_string(time_here()) + "}"},
             "the clock is being set\n");
}

}  // namespace adit::cli
