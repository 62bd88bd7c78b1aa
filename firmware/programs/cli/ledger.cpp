#include "cli/handlers.hpp"
#include "host/log.hpp"
#include "icd/try.hpp"
#include "ledger/dump.hpp"

namespace adit::cli {

Result<Outcome> dump_ledger(const Options& options, const Console& console) {
  const auto damage =
      ledger::dump(options.argument().empty() ? "/var/lib/adit/ledger" : options.argument(), console.print);
  if (!damage) return failed(damage.error().what);
  Outcome outcome;
  if (!damage->empty()) outcome.exit = Exit::Attention;
  for (const std::string& each : *damage) outcome.err += "adit: " + host::escaped(each) + '\n';
  return outcome;
}

Result<Outcome> begin_ledger(const Call& call) {
  ADIT_TRY(confirm(call.options, call.console,
                   "The files of the ledger that cannot be read will be kept, but Adit will not "
                   "know their reports: a report may be sent twice.",
                   "Begin another ledger?"));
  return act(call, {.target = "/adit/ledger/new", .check = "adit status"},
             "aditd restarts with another ledger: see adit status\n");
}

}  // namespace adit::cli
