#include "cli/doubt.hpp"

#include "api/run_view.hpp"
#include "cli/reading.hpp"
#include "dispatch/report_life.hpp"
#include "host/log.hpp"
#include "icd/sentence.hpp"

namespace adit::cli {
namespace {

std::string warning(const api::ReportRow& report) {
  const char* const asking = report.asking ? " Adit is asking the run's status to find out." : "";
  return icd::sentence("report ", report.number, " (", report.type,
                       ") is in doubt: if the Command Post recorded it, sending it again uses up a second "
                       "report.",
                       asking);
}

}  // namespace

std::optional<Failure> doubt(const Adit& adit, std::int64_t number, const Console& console) {
  const auto json = find(adit, "/adit/reports/" + std::to_string(number));
  if (!json) return json.error();
  const auto detail = read<api::ReportDetail>(adit, *json);
  if (!detail) return Failure{Exit::Unable, detail.error()};
  const api::ReportRow& report = detail->row;
  if (dispatch::state_named(report.state) != dispatch::ReportState::InDoubt) return std::nullopt;
  const std::string why = warning(report);
  const auto meant = console.ask(host::escaped(why) + "\nSend it again?");
  if (!meant) return Failure{Exit::Attention, why + " It was not sent; to send it, add --yes"};
  if (!*meant) return Failure{Exit::Attention, "report " + std::to_string(number) + " was not sent"};
  return std::nullopt;
}

std::optional<Failure> doubt(const Options& options, const Console& console, const std::string& why,
                             const std::string& question) {
  if (options.yes) return std::nullopt;
  const auto meant = console.ask(why + '\n' + question);
  if (!meant) return Failure{Exit::Attention, why + " It was not done; to do it, add --yes"};
  if (!*meant) return Failure{Exit::Attention, "it was not done"};
  return std::nullopt;
}

}  // namespace adit::cli
