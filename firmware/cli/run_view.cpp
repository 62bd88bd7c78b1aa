#include "cli/run_view.hpp"

#include "codec/field.hpp"
#include "codec/json.hpp"

namespace adit::cli {
namespace {

using codec::Field;

template <class Integer>
Integer whole(const Field& object, std::string_view name) {
  return object.member(name).whole<Integer>();
}

std::string text(const Field& object, std::string_view name) {
  return std::string(object.member(name).text());
}

double number(const Field& object, std::string_view name) {
  return object.member(name).number();
}

std::optional<double> number_or_null(const Field& object, std::string_view name) {
  const Field field = object.member(name);
  return field.is_absent() ? std::nullopt : std::optional(field.number());
}

/// Counts are never negative, and JSON's are below 2^63.
std::uint64_t count(const Field& object, std::string_view name) {
  return static_cast<std::uint64_t>(object.member(name).whole<std::int64_t>(0));
}

template <class Row>
std::vector<Row> rows(const Field& object, std::string_view name, Row (*read)(const Field&)) {
  const Field array = object.member(name);
  std::vector<Row> all;
  for (std::size_t i = 0; i < array.size() && !array.reading().refused(); ++i)
    all.push_back(read(array.element(i)));
  return all;
}

page::EndpointRow endpoint(const Field& row) {
  return {.name = text(row, "name"),
          .address = text(row, "address"),
          .connected = row.member("connected").truth(),
          .trouble = text(row, "trouble"),
          .last_status = whole<int>(row, "last_status"),
          .answer_ms = number_or_null(row, "answer_ms")};
}

page::ReportRow report(const Field& row) {
  const Field position = row.member("position");
  const Field score = row.member("score_change");
  page::ReportRow read;
  read.number = whole<std::int64_t>(row, "number");
  read.type = text(row, "type");
  read.position = {number(position, "x"), number(position, "y"), number(position, "z")};
  read.sender = text(row, "sender");
  read.received = number(row, "received");
  read.changed = number(row, "changed");
  read.state = text(row, "state");
  read.status = whole<int>(row, "status");
  read.report_status = text(row, "report_status");
  if (!score.is_absent()) read.score_change = score.whole<std::int64_t>();
  read.note = text(row, "note");
  return read;
}

page::ActivityRow activity(const Field& row) {
  page::ActivityRow read;
  read.kind = text(row, "kind");
  read.robot = text(row, "robot");
  read.accepted = count(row, "accepted");
  read.forwarded = count(row, "forwarded");
  read.replaced = count(row, "replaced");
  read.merged = count(row, "merged");
  read.throttled = count(row, "throttled");
  read.failed = count(row, "failed");
  read.refused_upstream = count(row, "refused_upstream");
  read.waiting = count(row, "waiting");
  read.last_accepted = number_or_null(row, "last_accepted");
  read.last_forwarded = number_or_null(row, "last_forwarded");
  read.bytes_received = count(row, "bytes_received");
  read.bytes_sent = count(row, "bytes_sent");
  read.last_status = whole<int>(row, "last_status");
  read.last_sentence = text(row, "last_sentence");
  return read;
}

page::RefusalRow refusal(const Field& row) {
  return {.at = number(row, "at"),
          .uri = text(row, "uri"),
          .sender = text(row, "sender"),
          .status = whole<int>(row, "status"),
          .sentence = text(row, "sentence")};
}

std::string sentence(const Field& element) {
  return std::string(element.text());
}

std::optional<icd::RunStatus> run(const Field& object) {
  const Field status = object.member("run");
  if (status.is_absent()) return std::nullopt;
  return icd::RunStatus{.score = whole<std::int64_t>(status, "score"),
                        .run_clock = number(status, "run_clock"),
                        .remaining_reports = whole<std::int64_t>(status, "remaining_reports"),
                        .current_team = text(status, "current_team")};
}

}  // namespace

std::expected<page::RunView, std::string> read_run_view(std::string_view json) {
  const auto root = codec::parse_json(json);
  if (!root) return std::unexpected("its answer is no JSON: " + root.error());
  codec::Reading reading;
  const Field object(*root, reading);
  page::RunView view;
  view.now = number(object, "now");
  view.version = text(object, "version");
  view.run = run(object);
  view.run_heard = number_or_null(object, "run_heard");
  view.endpoints = rows(object, "endpoints", endpoint);
  view.reports = rows(object, "reports", report);
  view.activities = rows(object, "activities", activity);
  view.refusals = rows(object, "refusals", refusal);
  view.budget_mbit = number(object, "budget_mbit");
  view.sent_mbit = number(object, "sent_mbit");
  view.queued_bytes = count(object, "queued_bytes");
  view.attention = rows(object, "attention", sentence);
  auto read = reading.outcome(std::move(view));
  if (!read) return std::unexpected("its answer is not of this version of Adit: " + read.error().sentence);
  return std::move(*read);
}

}  // namespace adit::cli
