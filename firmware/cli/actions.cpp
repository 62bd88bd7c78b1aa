#include "cli/actions.hpp"

#include <algorithm>

#include "cli/doubt.hpp"
#include "cli/reading.hpp"
#include "cli/where.hpp"
#include "host/log.hpp"

namespace adit::cli {
namespace {

/// Asks for an action, and gives the number that Adit answers under `name`. `check`: the command that tells
/// whether an action was done whose answer was lost.
std::expected<std::int64_t, Failure> ask(const Adit& adit, const std::string& target, const char* name,
                                         const std::string& check) {
  const auto body = post(adit, target, "", check);
  if (!body) return std::unexpected(body.error());
  auto number = read<std::int64_t>(
      adit, *body, [name](const codec::Field& object) { return whole<std::int64_t>(object, name); });
  if (number) return *number;
  return std::unexpected(Failure{Exit::Unable, number.error()});
}

std::string path_of(Verb verb) {
  switch (verb) {
    case Verb::Send:
      return "send";
    case Verb::Hold:
      return "hold";
    case Verb::Withdraw:
      return "withdraw";
    case Verb::Settle:
      return "settle";
    default:
      return "resubmit";
  }
}

/// What was done to report `number`; `moved` is what Adit answered.
std::string done(Verb verb, std::int64_t number, std::int64_t moved) {
  const std::string report = "report " + std::to_string(number);
  switch (verb) {
    case Verb::Send:
      return report + " is queued";
    case Verb::Hold:
      return report + " is held until you send it";
    case Verb::Withdraw:
      return report + " is withdrawn";
    case Verb::Settle:
      return report + " is settled";
    default:
      return report + " is sent again as report " + std::to_string(moved);
  }
}

std::string json_line(const char* name, std::int64_t number) {
  return codec::write_json({codec::Value::Object{{name, {number}}}}) + '\n';
}

void add(Outcome& outcome, const Failure& failure) {
  outcome.exit = std::max(outcome.exit, failure.exit);
  outcome.err += unable(failure.sentence).err;
}

}  // namespace

Outcome judge(const Adit& adit, const Options& options, const Console& console) {
  Outcome outcome;
  for (const std::int64_t number : options.numbers) {
    const std::string text = std::to_string(number);
    if (options.verb == Verb::Send && !options.yes) {
      if (const auto hindrance = doubt(adit, number, console)) {
        add(outcome, *hindrance);
        if (hindrance->exit == Exit::Unable) break;
        continue;
      }
    }
    const auto moved = ask(adit, "/adit/reports/" + text + "/" + path_of(options.verb), "report",
                           options.verb == Verb::Resubmit ? "adit reports" : "adit reports show " + text);
    if (moved) {
      outcome.out += options.json ? json_line("report", *moved) : done(options.verb, number, *moved) + '\n';
      continue;
    }
    add(outcome, moved.error());
    if (moved.error().exit == Exit::Unable) break;
  }
  return outcome;
}

Outcome begin_run(const Options& options) {
  const auto adit = adit_of(options);
  if (!adit) return unable(adit.error());
  const auto run = ask(*adit, "/adit/runs", "run", "adit reports");
  Outcome outcome;
  if (!run) {
    add(outcome, run.error());
  } else if (options.json) {
    outcome.out = json_line("run", *run);
  } else {
    outcome.out = "run " + std::to_string(*run) +
                  " begins; unsent reports of earlier runs are held: see adit reports\n";
  }
  return outcome;
}

Outcome identify(const Options& options) {
  const auto adit = adit_of(options);
  if (!adit) return unable(adit.error());
  const std::string seconds = std::to_string(options.seconds);
  const auto answer = post(*adit, "/adit/identify", "{\"seconds\":" + seconds + "}", "adit status");
  Outcome outcome;
  if (!answer) {
    add(outcome, answer.error());
  } else {
    outcome.out = options.json ? *answer + '\n' : "all lights flash for " + seconds + " s\n";
  }
  return outcome;
}

}  // namespace adit::cli
