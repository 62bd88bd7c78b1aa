#include "api/box_routes.hpp"

#include <algorithm>
#include <array>
#include <ctime>
#include <utility>

#include "api/answers.hpp"
#include "api/bundle.hpp"
#include "api/metrics.hpp"
#include "api/number_in.hpp"
#include "icd/letter_case.hpp"
#include "icd/refuse.hpp"

namespace adit::api {
namespace {

constexpr std::array<std::pair<std::string_view, int>, 5> kPriorities = {
    {{"error", 3}, {"warning", 4}, {"notice", 5}, {"info", 6}, {"debug", 7}}};

/// "adit-support-20260131T120000Z", or "adit-support" if the clock has no date.
std::string bundle_name(Time now) {
  const auto seconds = static_cast<std::time_t>(now);
  std::tm parts{};
  if (gmtime_r(&seconds, &parts) == nullptr) return "adit-support";
  char text[48];
  return {text, std::strftime(text, sizeof text, "adit-support-%Y%m%dT%H%M%SZ", &parts)};
}

intake::Answer download(intake::Answer answer, const std::string& name) {
  answer.headers.push_back({"Content-Disposition", "attachment; filename=\"" + name + "\""});
  return answer;
}

}  // namespace

bool LogFilter::lets(const LogRecord& record) const {
  if (record.severity > severity || record.seq <= after) return false;
  const auto same = [](char a, char b) { return icd::lower(a) == icd::lower(b); };
  return text.empty() || !std::ranges::search(record.line, text, same).empty();
}

icd::Checked<LogFilter> read_log_filter(const intake::RequestHead& head) {
  LogFilter filter{.text = std::string(head.query("text"))};
  if (const auto level = head.query("level"); !level.empty()) {
    const auto known = std::ranges::find(kPriorities, level, [](const auto& each) { return each.first; });
    if (known == kPriorities.end())
      return icd::refuse(icd::Status::BadRequest, "level: expected error, warning, notice, info or debug");
    filter.severity = known->second;
  }
  if (const auto since = head.query("since"); !since.empty()) {
    const auto number = icd::number_in<std::uint64_t>(since);
    if (!number) return icd::refuse(icd::Status::BadRequest, "since: expected the number of a record");
    filter.after = *number;
  }
  return filter;
}

std::string BoxRoutes::metrics_text() const {
  Measured measured{.view = source_.view(),
                    .reports = source_.report_counts(),
                    .usage = box_.usage(),
                    .about = box_.about()};
  for (const access::Session& session : entrance_.sessions().all(loop_.now())) {
    ++(session.role == access::Role::Operator ? measured.operators : measured.viewers);
  }
  return write_metrics(measured);
}

intake::Answer BoxRoutes::metrics() const {
  return fresh(Exposition::kContentType, metrics_text());
}

intake::Answer BoxRoutes::log(const intake::RequestHead& head) const {
  const auto filter = read_log_filter(head);
  if (!filter) return refused(filter.error());
  auto records = box_.log(filter->after);
  std::erase_if(records, [&](const LogRecord& record) { return !filter->lets(record); });
  return fresh(LogPage{box_.logged(), std::move(records)});
}

std::string BoxRoutes::log_lines(const LogFilter& filter) const {
  std::string lines;
  for (const LogRecord& record : box_.log(filter.after)) {
    if (filter.lets(record)) lines += record.line + "\n";
  }
  return lines;
}

intake::Answer BoxRoutes::log_text(const intake::RequestHead& head) const {
  const auto filter = read_log_filter(head);
  if (!filter) return refused(filter.error());
  return download(fresh("text/plain; charset=utf-8", log_lines(*filter)), "adit-log.txt");
}

std::string BoxRoutes::about_json() const {
  About about = box_.about();
  about.uptime = loop_.wall_now() - about.started;
  return codec::to_json(about);
}

intake::Answer BoxRoutes::about() const {
  return fresh("application/json", about_json());
}

void BoxRoutes::bundle(const Call& call) {
  lists_.write(json_list(), std::nullopt, [this, responder = call.responder](std::string reports) {
    pack(responder, std::move(reports));
  });
}

void BoxRoutes::pack(const std::shared_ptr<intake::Responder>& responder, std::string reports) {
  const Time now = loop_.wall_now();
  auto files = std::make_shared<std::vector<BundleFile>>();
  files->push_back({"about.json", about_json()});
  files->push_back({"run.json", codec::to_json(source_.view())});
  files->push_back({"reports.json", std::move(reports)});
  files->push_back({"settings.json", box_.settings()});
  files->push_back({"network.json", codec::to_json(box_.network())});
  files->push_back({"metrics.txt", metrics_text()});
  files->push_back({"log.txt", log_lines({})});
  auto packed = std::make_shared<std::string>();
  const auto write = [files, packed, now, redaction = redaction_] {
    for (auto& [name, body] : *files) {
      redact(*redaction, name.ends_with(".json") ? "application/json" : "text/plain", body);
    }
    *packed = write_bundle(std::move(*files), bundle_name(now), now);
  };
  box_.work(write, [responder, packed, now] {
    responder->answer(download(fresh("application/gzip", std::move(*packed)), bundle_name(now) + ".tar.gz"));
  });
}

}  // namespace adit::api
