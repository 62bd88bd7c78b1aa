#include "api/box_routes.hpp"

#include <algorithm>
#include <array>
#include <ctime>
#include <utility>
#include <vector>

#include "api/answers.hpp"
#include "api/bundle.hpp"
#include "api/metrics.hpp"
#include "api/route.hpp"
#include "api/settings_rows.hpp"
#include "codec/json.hpp"
#include "codec/row.hpp"
#include "icd/sentence.hpp"
#include "icd/text.hpp"
#include "icd/try.hpp"
#include "spare/sealed.hpp"

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

}  // namespace

struct LogFilter {
  int severity = 7;         // this severity and worse ones
  std::string text;         // part of the line, ignoring case; "": any
  std::uint64_t after = 0;  // only larger numbers

  bool matches(const LogRecord& record) const;
};

bool LogFilter::matches(const LogRecord& record) const {
  if (record.severity > severity || record.seq <= after) return false;
  const auto same = [](char a, char b) { return icd::lower(a) == icd::lower(b); };
  return text.empty() || !std::ranges::search(record.line, text, same).empty();
}

namespace {

/// Reads `?level=warning&text=...&since=17`. Error 400: an invalid value.
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

}  // namespace

std::string BoxRoutes::metrics_text() const {
  MetricsInput measured{.view = source_.view(),
                        .reports = source_.report_counts(),
                        .usage = box_.usage(),
                        .about = box_.about()};
  for (const access::Session& session : keys_.sessions().all(loop_.now())) {
    ++(session.role == access::Role::Operator ? measured.operators : measured.viewers);
  }
  return write_metrics(measured);
}

intake::Answer BoxRoutes::metrics() const {
  return uncached_answer(Exposition::kContentType, metrics_text());
}

icd::Checked<LogPage> BoxRoutes::log(const intake::RequestHead& head) const {
  const auto filter = ADIT_TRY(read_log_filter(head));
  auto records = box_.log(filter.after);
  std::erase_if(records, [&](const LogRecord& record) { return !filter.matches(record); });
  return LogPage{box_.last_record_number(), std::move(records)};
}

std::string BoxRoutes::log_lines(const LogFilter& filter) const {
  std::string lines;
  for (const LogRecord& record : box_.log(filter.after)) {
    if (filter.matches(record)) lines += record.line + "\n";
  }
  return lines;
}

icd::Checked<intake::Answer> BoxRoutes::log_text(const intake::RequestHead& head) const {
  const auto filter = ADIT_TRY(read_log_filter(head));
  return download(uncached_answer("text/plain; charset=utf-8", log_lines(filter)), "adit-log.txt");
}

std::string BoxRoutes::about_json() const {
  About about = box_.about();
  about.uptime = loop_.wall_now() - about.started;
  return codec::to_json(about);
}

intake::Answer BoxRoutes::about() const {
  return uncached_answer("application/json", about_json());
}

void BoxRoutes::bundle(const Call& call) {
  lists_.write(json_list(), std::nullopt,
               [this, responder = call.responder, redaction = call.redaction](std::string reports) {
                 pack(responder, redaction, std::move(reports));
               });
}

void BoxRoutes::pack(const std::shared_ptr<intake::Responder>& responder, const SharedRedaction& redaction,
                     std::string reports) {
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
  const auto write = [files, packed, now, redaction] {
    for (auto& [name, body] : *files) {
      redact(*redaction, name.ends_with(".json") ? "application/json" : "text/plain", body);
    }
    *packed = write_bundle(std::move(*files), bundle_name(now), now);
  };
  box_.work(write, [responder, packed, now] {
    responder->answer(
        download(uncached_answer("application/gzip", std::move(*packed)), bundle_name(now) + ".tar.gz"));
  });
}

namespace {

/// The numbers, or all errors of the body.
std::expected<network::Numbers, std::vector<settings::Error>> numbers_in(const std::string& body) {
  const auto value = codec::parse_json(body);
  if (value) return network::read_numbers(*value);
  return std::unexpected(std::vector<settings::Error>{{"", "expected JSON: " + value.error()}});
}

}  // namespace

namespace network_routes {

CheckView check(Network& network, const Call& call) {
  const auto wanted = numbers_in(call.body);
  const auto findings =
      wanted ? network.check(*wanted, call.head.peer()) : network::Findings{wanted.error(), {}, {}};
  CheckView checked{.errors = findings.errors, .changes = {.changes = {}, .warnings = findings.warnings}};
  for (const network::Difference& each : findings.changes)
    checked.changes.changes.push_back({each.path, {each.from}, {each.to}});
  return checked;
}

intake::Answer change(Network& network, const Call& call) {
  const auto wanted = numbers_in(call.body);
  if (!wanted) return refusal_answer(wanted.error());
  const auto findings = network.check(*wanted, call.head.peer());
  if (!findings.errors.empty()) return refusal_answer(findings.errors);
  return answer_after(network, network.change(*wanted));
}

icd::Checked<void> confirm(Network& network, const Call& call) {
  return network.confirm(call.head.local());
}

}  // namespace network_routes

namespace {

/// Streams a body to an Upload.
class UploadSink final : public intake::BodySink {
 public:
  UploadSink(std::unique_ptr<Upload> upload, std::uint64_t size, std::function<void(icd::Checked<void>)> done)
      : upload_(std::move(upload)), size_(size), done_(std::move(done)) {}
  bool on_body(std::span<const std::uint8_t> piece) override {
    if (!upload_) return true;
    const bool known = head_.size() >= update::kBundleHead;
    if (!known) {
      const std::size_t more = std::min(piece.size(), update::kBundleHead - head_.size());
      head_.insert(head_.end(), piece.begin(), piece.begin() + static_cast<std::ptrdiff_t>(more));
      if (head_.size() >= update::kBundleHead && !check_bundle()) return true;
    }
    return upload_->write(piece);
  }
  void on_end() override {
    const bool known = head_.size() >= update::kBundleHead;
    if (upload_ && (known || check_bundle())) upload_->finish(std::move(done_));
  }
  void on_gone() override { upload_.reset(); }

 private:
  /// False: rejected, and the rest is discarded.
  bool check_bundle() {
    const std::string why = update::bundle_error(head_, size_);
    if (why.empty()) return true;
    upload_.reset();
    done_(icd::unprocessable(why));
    return false;
  }

  std::unique_ptr<Upload> upload_;  // null: rejected
  std::uint64_t size_;
  std::vector<std::uint8_t> head_;
  std::function<void(icd::Checked<void>)> done_;
};

}  // namespace

std::unique_ptr<intake::BodySink> update_routes::receive(Updates& updates, const Call& call) {
  const auto refuse = [&call](intake::Answer answer) {
    call.responder->answer(std::move(answer));
    return nullptr;
  };
  const auto unprocessable = [](std::string_view why) {
    return refusal(icd::Status::UnprocessableEntity, why);
  };
  const auto size = call.head.content_length();
  if (!size || *size == 0) return refuse(unprocessable("Content-Length: expected the bundle's size"));
  const std::string_view again = call.head.query("again");
  if (!again.empty() && again != "0" && again != "1") return refuse(unprocessable("again: expected 0 or 1"));
  auto upload = updates.receive(*size, again == "1", [flow = call.flow] { flow->resume(); });
  if (!upload) return refuse(refusal_answer(upload.error()));
  return std::make_unique<UploadSink>(std::move(*upload), *size,
                                      [&updates, responder = call.responder](const icd::Checked<void>& done) {
                                        responder->answer(answer_after(updates, done));
                                      });
}

namespace {

/// Receives an export. Rejects other data by its first bytes and discards the rest.
class ExportSink final : public intake::BodySink {
 public:
  explicit ExportSink(std::function<void(icd::Checked<std::string>)> done) : done_(std::move(done)) {}

  bool on_body(std::span<const std::uint8_t> piece) override {
    if (!done_) return true;
    file_.append(reinterpret_cast<const char*>(piece.data()), piece.size());
    if (file_.size() >= spare::kExportHead) check_export();
    return true;
  }
  void on_end() override {
    if (done_) check_export();
    if (done_) std::exchange(done_, nullptr)(std::move(file_));
  }

 private:
  void check_export() {
    const std::string why = spare::export_error(file_);
    if (why.empty()) return;
    file_.clear();
    std::exchange(done_, nullptr)(icd::unprocessable(why));
  }

  std::function<void(icd::Checked<std::string>)> done_;
  std::string file_;
};

}  // namespace

namespace certificate_routes {
namespace {

Certificate::Done answer_with_state(const Certificate& certificate, const Call& call) {
  return [&certificate, responder = call.responder](const icd::Checked<void>& done) {
    responder->answer(answer_after(certificate, done));
  };
}

}  // namespace

void replace_certificate(Certificate& certificate, const Call& call) {
  if (!call.head.is_secure() && !is_from_this_machine(call.head))
    return call.responder->answer(
        refusal(icd::Status::Conflict, "upload the certificate by HTTPS, because others could read its key"));
  certificate.replace(call.body, answer_with_state(certificate, call));
}

void make(Certificate& certificate, const Call& call) {
  certificate.make(answer_with_state(certificate, call));
}

}  // namespace certificate_routes

namespace spare_routes {

void send_export(Spare& spare, const Call& call) {
  spare.export_to([responder = call.responder](icd::Checked<std::string> file) {
    if (!file) return responder->answer(refusal_answer(file.error()));
    responder->answer(
        download(uncached_answer("application/octet-stream", *std::move(file)), "export.adit-spare"));
  });
}

void export_to_stick(Spare& spare, const Call& call) {
  spare.export_to_stick([&spare, responder = call.responder](const icd::Checked<void>& done) {
    responder->answer(answer_after(spare, done));
  });
}

std::unique_ptr<intake::BodySink> begin_import(Spare& spare, const Call& call) {
  if (call.head.content_length().value_or(spare::kLargestExport + 1) > spare::kLargestExport) {
    call.responder->answer(SmallBody::too_long(spare::kLargestExport, "export"));
    return nullptr;
  }
  return std::make_unique<ExportSink>([&spare, responder = call.responder](icd::Checked<std::string> file) {
    responder->answer(file ? answer_after(spare, spare.import_file(*std::move(file)))
                           : refusal_answer(file.error()));
  });
}

void open(Spare& spare, const Call& call) {
  const auto code = read_text(call.body, "code");
  if (!code) return call.responder->answer(refusal_answer(code.error()));
  spare.open(*code, [&spare, responder = call.responder](const icd::Checked<void>& done) {
    responder->answer(answer_after(spare, done));
  });
}

icd::Checked<void> take_over(Spare& spare, const std::string& body) {
  const auto unplugged = ADIT_TRY(
      read_body<bool>(body, [](const codec::Field& root) { return root.member("unplugged").truth(); }));
  if (!unplugged)
    return icd::unprocessable("unplugged: expected true, because the box that made the export must be off");
  return spare.take_over();
}

}  // namespace spare_routes
}  // namespace adit::api
