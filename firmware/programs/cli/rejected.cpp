#include <algorithm>

#include "api/run_view.hpp"
#include "cli/handlers.hpp"
#include "cli/table.hpp"
#include "cli/words.hpp"
#include "icd/try.hpp"

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

}  // namespace

Result<Outcome> list_rejected(const Call& call) {
  const api::RunView view = ADIT_TRY(fetch<api::RunView>(call.adit, "/adit/run")).row;
  const bool waits =
      std::ranges::any_of(view.rejected, [](const api::RejectedRow& row) { return !row.replaced; });
  return printed(call, codec::to_json(view.rejected), table_of(view, call.console.colour),
                 waits ? Exit::Attention : Exit::Fine);
}

Result<Outcome> decide_on_rejected(const Call& call) {
  const std::string verb = call.options.word();
  return act_on_each(call, [&](std::int64_t number) {
    return act(call,
               {.target = icd::sentence("/adit/rejected/", number, "/", verb), .check = "adit rejected"},
               icd::sentence("message ", number, verb == "send" ? " is queued again\n" : " is deleted\n"));
  });
}

}  // namespace adit::cli
