#include "cli/ledger.hpp"

#include "cli/ask.hpp"
#include "cli/doubt.hpp"
#include "host/log.hpp"
#include "ledger/dump.hpp"

namespace adit::cli {
namespace {

constexpr const char* kLedger = "/var/lib/adit/ledger";

Outcome dump(const Options& options, const Console& console) {
  const auto damage = ledger::dump(options.file.empty() ? kLedger : options.file, console.print);
  if (!damage) return unable(damage.error().what);
  Outcome outcome;
  if (!damage->empty()) outcome.exit = Exit::Attention;
  for (const std::string& each : *damage) outcome.err += "adit: " + host::escaped(each) + '\n';
  return outcome;
}

}  // namespace

Outcome ledger(const Options& options, const Console& console) {
  if (options.verb == Verb::Dump) return dump(options, console);
  const auto adit = adit_of(options);
  if (!adit) return unable(adit.error());
  if (const auto why =
          doubt(options, console,
                "The files of the ledger that cannot be read will be kept, but Adit will not know "
                "their reports: a report may be sent twice.",
                "Begin another ledger?"))
    return unable(*why);
  const auto done = post(*adit, "/adit/ledger/new", "", "adit status");
  if (!done) return unable(done.error());
  return {Exit::Fine, options.json ? *done + '\n' : "aditd restarts with another ledger: see adit status\n",
          ""};
}

}  // namespace adit::cli
