#include "api/kept_runs_routes.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "api/answers.hpp"
#include "api/map_json.hpp"
#include "api/map_routes.hpp"
#include "api/read_body.hpp"

namespace adit::api {
namespace {

constexpr std::size_t kDetailsInATurn = 16;  // each is a query of the ledger

intake::Answer not_listed(const RunList& all) {
  return all.unreadable.empty() ? refused(no_such_run())
                                : refusal(icd::Status::ServiceUnavailable, all.unreadable);
}

/// A run's report contains its style and images, and no script. Other content must not load.
intake::Answer printed(std::string html) {
  return {.content_type = "text/html; charset=utf-8",
          .body = std::move(html),
          .headers = {{"Content-Security-Policy",
                       "default-src 'none'; style-src 'unsafe-inline'; img-src data:; base-uri 'none'; "
                       "frame-ancestors 'none'; form-action 'none'"},
                      {"X-Content-Type-Options", "nosniff"},
                      {"Referrer-Policy", "no-referrer"},
                      {"Cache-Control", "no-store"}}};
}

}  // namespace

KeptRunsRoutes::KeptRunsRoutes(loop::Loop& loop, KeptRuns& runs, const Source& source)
    : loop_(loop), runs_(runs), source_(source), forget_(loop.timer([this] { held_.reset(); })) {}

const RunRow* KeptRunsRoutes::row_of(const RunList& list, const std::string& key) const {
  const auto found = std::ranges::find(list.runs, key, &RunRow::key);
  return found == list.runs.end() ? nullptr : &*found;
}

intake::Answer KeptRunsRoutes::history(const intake::RequestHead& head) const {
  const AskedNumber since = asked_number(head, "since");
  if (since.wrong) return refusal(icd::Status::BadRequest, "since: expected seconds since 1970");
  return fresh(runs_.history(since.number.value_or(0)));
}

intake::Answer KeptRunsRoutes::list() const {
  return fresh(runs_.list());
}

intake::Answer KeptRunsRoutes::one(const Call& call) const {
  const RunList all = runs_.list();
  const RunRow* row = row_of(all, call.parameters.front());
  return row != nullptr ? fresh(*row) : not_listed(all);
}

void KeptRunsRoutes::with_run(const Call& call, Answering answer) {
  const std::string& key = call.parameters.front();
  if (held_ && held_->facts.key == key) {
    forget_.call_at(loop_.now() + kHeld);
    return call.responder->answer(answer(*held_));
  }
  auto& waiting = waiting_[key];
  if (waiting.size() >= kMostWaiting) {
    return call.responder->answer(refusal(icd::Status::ServiceUnavailable, "the run is being read"));
  }
  waiting.push_back({call.responder, std::move(answer)});
  if (waiting.size() > 1) return;
  runs_.read(key, [this, key](const auto& run) { came(key, run); });
}

void KeptRunsRoutes::came(const std::string& key, const icd::Checked<std::shared_ptr<const KeptRun>>& run) {
  const auto waiting = std::exchange(waiting_[key], {});
  waiting_.erase(key);
  for (const Waiting& each : waiting) each.responder->answer(run ? each.answer(**run) : refused(run.error()));
  const RunList all = runs_.list();
  const RunRow* row = row_of(all, key);
  if (!run || row == nullptr || row->is_present) return;  // the present run changes
  held_ = *run;
  forget_.call_at(loop_.now() + kHeld);
}

void KeptRunsRoutes::layers(const Call& call) {
  const auto since = version_asked(call.head);
  if (!since) return call.responder->answer(since.error());
  with_run(call, [since = *since](const KeptRun& run) { return fresh(map_view(run.picture, since)); });
}

void KeptRunsRoutes::tile(const Call& call) {
  const auto asked = tile_asked(call.head, std::span(call.parameters).subspan(1));
  if (!asked) return call.responder->answer(asked.error());
  with_run(call, [asked = *asked](const KeptRun& run) { return tile_of(run.picture, asked); });
}

void KeptRunsRoutes::tracks(const Call& call) {
  with_run(call, [](const KeptRun& run) { return fresh(thinned(run.tracks)); });
}

void KeptRunsRoutes::plots(const Call& call) {
  with_run(call, [](const KeptRun& run) { return fresh(run.history); });
}

/// Collects the reports of a run, some in each turn of the loop.
struct KeptRunsRoutes::Gathering {
  std::string key;
  std::int64_t run = 0, last = 0;
  std::vector<ReportDetail> reports;
  std::shared_ptr<intake::Responder> responder;
};

void KeptRunsRoutes::report(const Call& call) {
  const RunList all = runs_.list();
  const RunRow* row = row_of(all, call.parameters.front());
  if (row == nullptr) return call.responder->answer(not_listed(all));
  gather(std::make_shared<Gathering>(row->key, row->run, 0, std::vector<ReportDetail>(), call.responder));
}

void KeptRunsRoutes::gather(const std::shared_ptr<Gathering>& gathering) {
  const auto rows = source_.reports(gathering->last, kDetailsInATurn);
  for (const ReportRow& row : rows) {
    gathering->last = row.number;
    if (row.run != gathering->run) continue;
    if (auto detail = source_.report(row.number)) gathering->reports.push_back(std::move(*detail));
  }
  if (rows.size() == kDetailsInATurn) {
    return loop_.post([this, gathering] { gather(gathering); });
  }
  runs_.report(gathering->key, std::move(gathering->reports), source_.view().colours,
               [responder = gathering->responder](icd::Checked<std::string> html) {
                 responder->answer(html ? printed(*std::move(html)) : refused(html.error()));
               });
}

void KeptRunsRoutes::remove(const Call& call) {
  const RunList all = runs_.list();
  const RunRow* row = row_of(all, call.parameters.front());
  if (row == nullptr) return call.responder->answer(not_listed(all));
  if (held_ && held_->facts.key == row->key) held_.reset();
  runs_.remove(row->key,
               [key = row->key, responder = call.responder](const std::expected<void, std::string>& done) {
                 responder->answer(done ? object({{"key", codec::json(key)}})
                                        : refusal(icd::Status::Conflict, done.error()));
               });
}

}  // namespace adit::api
