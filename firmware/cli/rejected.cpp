#include "cli/rejected.hpp"

#include <algorithm>

#include "api/run_view.hpp"
#include "cli/ask.hpp"
#include "cli/reading.hpp"
#include "cli/table.hpp"
#include "cli/where.hpp"
#include "cli/words.hpp"

namespace adit::cli {
namespace {

using Align = Table::Align;

std::string table_of(const api::RunView& view, bool colour) {
  if (view.rejected.empty()) return "0 rejected messages\n";
  Table table({{"number", Align::Right},
               {"kind"},
               {"robot"},
               {"rejected", Align::Right},
               {"size", Align::Right},
               {"answer"},
               {""}});
  for (const api::RejectedRow& row : view.rejected) {
    table.add({{std::to_string(row.number), Tone::Strong},
               {row.kind},
               {row.robot.empty() ? "(all)" : row.robot},
               {duration(view.now - row.at) + " ago"},
               {size(row.bytes)},
               {answer_of(row.status, row.why), row.replaced ? Tone::Faint : Tone::Bad},
               {row.replaced ? "replaced by a newer one" : "", Tone::Faint}});
  }
  return table.written(colour);
}

Outcome list_rejected(const Adit& adit, const Options& options, bool colour) {
  const auto view = run_view(adit);
  if (!view) return unable(view.error());
  const bool waits =
      std::ranges::any_of(view->rejected, [](const api::RejectedRow& row) { return !row.replaced; });
  const Exit exit = waits ? Exit::Attention : Exit::Fine;
  if (options.json) return {exit, codec::to_json(view->rejected) + '\n', ""};
  return {exit, table_of(*view, colour), ""};
}

}  // namespace

Outcome rejected(const Options& options, bool colour) {
  const auto adit = adit_of(options);
  if (!adit) return unable(adit.error());
  if (options.verb == Verb::Show) return list_rejected(*adit, options, colour);
  Outcome outcome;
  for (const std::int64_t number : options.numbers) {
    const std::string text = std::to_string(number);
    const auto answer =
        post(*adit, "/adit/rejected/" + text + (options.verb == Verb::Send ? "/send" : "/discard"), "",
             "adit rejected");
    if (!answer) {
      outcome.exit = std::max(outcome.exit, answer.error().exit);
      outcome.err += unable(answer.error().sentence).err;
      if (answer.error().exit == Exit::Unable) break;
    } else if (options.json) {
      outcome.out += *answer + '\n';
    } else {
      outcome.out +=
          "message " + text + (options.verb == Verb::Send ? " is queued again\n" : " is deleted\n");
    }
  }
  return outcome;
}

}  // namespace adit::cli
