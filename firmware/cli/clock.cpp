#include "cli/clock.hpp"

#include <chrono>
#include <cmath>

#include "cli/ask.hpp"
#include "cli/reading.hpp"
#include "cli/where.hpp"
#include "cli/words.hpp"
#include "host/log.hpp"
#include "icd/sentence.hpp"
#include "icd/utc.hpp"

namespace adit::cli {
namespace {

constexpr double kAsHere = 2;  // seconds

/// What `adit clock` shows of GET /adit/clock.
struct ToldClock {
  double now = 0;
  bool managed = false, is_set = false;
  std::string why, source, refusal, ntp;
};

ToldClock read_clock(const codec::Field& root) {
  return {.now = number(root, "now"),
          .managed = root.member("managed").truth(),
          .is_set = root.member("is_set").truth(),
          .why = text(root, "why"),
          .source = text(root, "source"),
          .refusal = text(root, "refusal"),
          .ntp = text(root, "ntp")};
}

double time_here() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

std::string spoken(const std::string& source) {
  if (source == "none") return "not set since boot";
  if (source == "last_known") return "continued from the last known time";
  if (source == "robots") return "set by the robots' stamps";
  if (source == "command_post") return "set by the Command Post's answers";
  if (source == "chip") return "set by the box's clock chip";
  if (source == "ntp") return "set by an NTP server";
  return "set by an operator";
}

std::string text_of(const ToldClock& view, double here) {
  const double ahead = view.now - here;
  const std::string apart =
      std::abs(ahead) <= kAsHere
          ? "the same as on this computer"
          : icd::sentence(duration(std::abs(ahead)), ahead > 0 ? " ahead of" : " behind", " this computer");
  const std::string date = icd::utc(view.now);
  std::string out = icd::sentence(date.empty() ? "date unknown" : date + " UTC", ", ", apart, "\n");
  out += view.managed ? spoken(view.source) + '\n'
                      : icd::sentence("Adit cannot set it: ", host::escaped(view.why), "\n");
  if (!view.refusal.empty()) out += icd::sentence("Not set: ", host::escaped(view.refusal), "\n");
  if (!view.ntp.empty()) out += host::escaped(view.ntp) + '\n';
  if (!view.is_set && view.managed) out += "To set it to this computer's time: adit clock set\n";
  return out;
}

Outcome shown(const Adit& adit, const Options& options, const std::string& json) {
  const auto view = read<ToldClock>(adit, json, read_clock);
  if (!view) return unable(view.error());
  const Exit exit = view->is_set && view->refusal.empty() ? Exit::Fine : Exit::Attention;
  return {exit, options.json ? json + '\n' : text_of(*view, time_here()), ""};
}

}  // namespace

Outcome clock(const Options& options) {
  const auto adit = adit_of(options);
  if (!adit) return unable(adit.error());
  if (options.verb == Verb::Show) {
    const auto json = get(*adit, "/adit/clock");
    return json ? shown(*adit, options, *json) : unable(json.error());
  }
  const std::string body = "{\"time\":" + std::to_string(time_here()) + "}";
  const auto json = post(*adit, "/adit/clock", body, "adit clock");
  if (!json) return unable(json.error());
  return {Exit::Fine, options.json ? *json + '\n' : "the clock is being set\n", ""};
}

}  // namespace adit::cli
