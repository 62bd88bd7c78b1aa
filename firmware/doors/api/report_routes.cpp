#include "api/report_routes.hpp"

#include <memory>
#include <optional>
#include <utility>

#include "api/answers.hpp"
#include "api/reports_csv.hpp"
#include "api/route.hpp"
#include "codec/body_decoder.hpp"
#include "codec/field.hpp"
#include "codec/read.hpp"
#include "codec/row.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"

namespace adit::api {
namespace {

/// Reports for half a millisecond of work.
constexpr std::size_t kInATurn = 64;

}  // namespace

struct ReportLists::Listing {
  const ListForm form;
  const std::optional<std::int64_t> run;
  const std::function<void(std::string)> done;
  std::string text = form.begin;
  std::int64_t last = 0;  // the last written report
  bool is_empty = true;
};

ListForm json_list() {
  return {.begin = "[",
          .row = [](const facts::ReportRow& row) { return codec::to_json(row); },
          .between = ",",
          .end = "]"};
}

void ReportLists::write(ListForm form, std::optional<std::int64_t> run,
                        std::function<void(std::string list)> done) const {
  continue_listing(std::make_shared<Listing>(std::move(form), run, std::move(done)));
}

void ReportLists::continue_listing(const std::shared_ptr<Listing>& listing) const {
  const auto rows = source_.reports(listing->last, kInATurn);
  for (const facts::ReportRow& row : rows) {
    listing->last = row.number;
    if (listing->run && row.run != *listing->run) continue;
    if (!std::exchange(listing->is_empty, false)) listing->text += listing->form.between;
    listing->text += listing->form.row(row);
  }
  if (rows.size() == kInATurn) {
    return loop_.post([this, listing] { continue_listing(listing); });
  }
  listing->done(std::move(listing->text.append(listing->form.end)));
}

using codec::json;
namespace {

constexpr std::string_view kAll = "all", kPresent = "present";
constexpr auto kAccepted = static_cast<icd::Status>(202);  // RFC 9110 15.3.3; not in the ICD

std::unexpected<icd::Refusal> not_found(std::int64_t number) {
  return icd::refuse(icd::Status::NotFound, "there is no report ", number);
}

/// Reads the operator's report and gives it to `take`, which returns its number or why it was not accepted.
template <class Take>
icd::Checked<intake::Answer> accept(const std::string& body, Take take) {
  const auto document = ADIT_TRY(codec::decode({}, codec::Split::Nothing, body));
  const auto read = ADIT_TRY(codec::read_artifact_report(document, {}));
  codec::Reading reading;
  const codec::Field root(document.root, reading);
  const codec::Field resubmit = root.member("resubmit");
  const bool again = ADIT_TRY(reading.outcome(!resubmit.is_absent() && resubmit.truth()));
  const auto number = take(read.report, again);
  if (!number) return icd::conflict(number.error());
  codec::Value::Object told{{"report", json(*number)}};
  if (!read.left_out.empty()) told.emplace_back("left_out", json(read.left_out));
  return object(std::move(told));
}

}  // namespace

void ReportRoutes::send_list(const Call& call, ListForm form, intake::Answer begun) const {
  std::optional<std::int64_t> run;
  if (const auto named = call.head.query("run"); !named.empty() && named != kAll) {
    run = named == kPresent ? source_.view().run_number : icd::number_in<std::int64_t>(named);
    if (!run)
      return call.responder->answer(
          refusal(icd::Status::BadRequest, "run: expected a run's number, present or all"));
  }
  const auto answer = [responder = call.responder, begun = std::move(begun)](std::string list) mutable {
    begun.body = std::move(list);
    responder->answer(std::move(begun));
  };
  lists_.write(std::move(form), run, answer);
}

void ReportRoutes::list(const Call& call) const {
  send_list(call, json_list(), uncached_answer("application/json", ""));
}

void ReportRoutes::csv(const Call& call) const {
  send_list(call, {.begin = csv_header(), .row = csv_line, .between = "", .end = ""},
            download(uncached_answer("text/csv; charset=utf-8; header=present", ""), "adit-reports.csv"));
}

icd::Checked<ReportDetail> ReportRoutes::one(std::int64_t number) const {
  if (auto report = source_.report(number)) return *std::move(report);
  return not_found(number);
}

icd::Checked<intake::Answer> ReportRoutes::decide(std::int64_t number, Action action) {
  if (!source_.report(number)) return not_found(number);
  const auto moved = operator_.decide(number, action);
  if (!moved) return icd::conflict(moved.error());
  return object({{"report", json(*moved)}});
}

icd::Checked<intake::Answer> ReportRoutes::compose(const std::string& body) {
  auto answer = accept(body, [this](const icd::ArtifactReport& report, bool resubmit) {
    return operator_.report(report, resubmit);
  });
  if (answer) answer->status = kAccepted;
  return answer;
}

icd::Checked<intake::Answer> ReportRoutes::correct(const Call& call) {
  const auto number = icd::number_in<std::int64_t>(call.parameters.front());
  if (!number) return std::unexpected(nothing_at(call.head.path()));
  if (!source_.report(*number)) return not_found(*number);
  return accept(call.body, [this, number](const icd::ArtifactReport& report, bool /*resubmit*/) {
    return operator_.correct(*number, report);
  });
}

}  // namespace adit::api
