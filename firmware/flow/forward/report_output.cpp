#include "forward/report_output.hpp"

#include <utility>

#include "forward/channel.hpp"
#include "host/log.hpp"
#include "intake/answer.hpp"

namespace adit::forward {
namespace {

using dispatch::ReportState;

intake::Answer answer_of(const dispatch::ClientAnswer& answer, const dispatch::Report& report) {
  if (!answer.sentence.empty()) return intake::error_answer(answer.status, answer.sentence);
  // A report's answer has been parsed as JSON.
  if (report.state == ReportState::Answered || report.state == ReportState::Settled) {
    return {.status = static_cast<icd::Status>(report.status), .body = report.answer, .headers = {}};
  }
  return client_answer({.status = report.status,
                        .content_type = report.content_type,
                        .body = report.answer,
                        .retry_after = std::nullopt});
}

}  // namespace

ReportOutput::ReportOutput(loop::Loop& loop, ledger::Ledger& ledger)
    : loop_(loop),
      ledger_(ledger),
      follow_up_(loop.timer([this] { follow_up(); })),
      try_again_(loop.timer([this] { on_tried(ledger_.make_ready()); })),
      trouble_(ledger.refusal()) {
  if (trouble_.empty()) return;
  host::log(
      host::Level::Error,
      std::string("rejecting reports: the ledger cannot be ") + (ledger.is_closed() ? "read" : "written"),
      {{"why", trouble_}});
  try_again_.call_at(loop.now() + kTryEvery);
}

void ReportOutput::on_tried(const ledger::Result<void>& result) {
  const bool was_well = trouble_.empty();
  trouble_ = result ? "" : result.error().what;
  if (result && !was_well) host::log(host::Level::Notice, "the ledger can be written again");
  if (!result && was_well) host::log(host::Level::Error, "the ledger cannot be written", {{"why", trouble_}});
  if (!result) try_again_.call_at(loop_.now() + kTryEvery);
}

/// The log may wait for its reader.
void ReportOutput::follow_up() {
  const auto flushed = ledger_.flush();
  if (!flushed)
    host::log(host::Level::Error, "the ledger cannot be flushed", {{"why", flushed.error().what}});
  for (const Step& step : std::exchange(unlogged_, {})) {
    const bool for_the_operator = step.state == ReportState::InDoubt || step.state == ReportState::Held;
    host::log(for_the_operator ? host::Level::Warning : host::Level::Notice,
              "report " + std::string(dispatch::display_name(step.state)),
              {{"report", std::to_string(step.number)},
               {"type", step.type},
               {"sender", step.sender},
               {"status", step.status != 0 ? std::to_string(step.status) : ""},
               {"why", step.note}});
  }
}

dispatch::ClientId ReportOutput::add(std::shared_ptr<intake::Responder> responder) {
  clients_[++last_client_] = std::move(responder);
  return last_client_;
}

bool ReportOutput::write(std::span<const dispatch::Report> steps, const dispatch::Run* run,
                         dispatch::Flush flush) {
  const auto written = ledger_.write(steps, run, flush);
  if (!written || ledger_.refusal().empty()) on_tried(written);
  if (!written) return false;
  for (const dispatch::Report& report : steps) {
    unlogged_.push_back(
        {report.number, report.report.type, report.sender, report.state, report.status, report.note});
  }
  follow_up_.call_at(loop_.now() + kSoon);
  return true;
}

void ReportOutput::answer_client(dispatch::ClientId client, const dispatch::ClientAnswer& answer,
                                 const dispatch::Report& report) {
  last_told_ = answer;
  const auto waiting = clients_.extract(client);
  if (!waiting) return;
  intake::Answer told = answer_of(answer, report);
  if (answer.number != 0) told.headers.push_back({"Adit-Report", std::to_string(answer.number)});
  if (answer.sentence.empty() && report.reconciled) told.headers.push_back({"Adit-Reconciled", "yes"});
  waiting.mapped()->answer(std::move(told));
}

}  // namespace adit::forward
