#include "cli/run_view.hpp"

#include "cli/reading.hpp"
#include "cli/report_rows.hpp"

namespace adit::cli {
namespace {

using codec::Field;

api::EndpointRow endpoint(const Field& row) {
  return {.name = text(row, "name"),
          .address = text(row, "address"),
          .connected = row.member("connected").truth(),
          .trouble = text(row, "trouble"),
          .last_status = whole<int>(row, "last_status"),
          .answer_ms = number_or_null(row, "answer_ms")};
}

api::ActivityRow activity(const Field& row) {
  api::ActivityRow read;
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

api::AsideRow aside(const Field& row) {
  return {.number = count(row, "number"),
          .kind = text(row, "kind"),
          .robot = text(row, "robot"),
          .at = number(row, "at"),
          .status = whole<int>(row, "status"),
          .why = text(row, "why"),
          .bytes = count(row, "bytes"),
          .overtaken = row.member("overtaken").truth()};
}

api::RefusalRow refusal(const Field& row) {
  return {.at = number(row, "at"),
          .uri = text(row, "uri"),
          .sender = text(row, "sender"),
          .status = whole<int>(row, "status"),
          .sentence = text(row, "sentence"),
          .parts = count(row, "parts")};
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

std::expected<api::RunView, std::string> read_run_view(std::string_view json) {
  return read<api::RunView>(json, [](const Field& object) {
    api::RunView view;
    view.now = number(object, "now");
    view.version = text(object, "version");
    view.run = run(object);
    view.run_heard = number_or_null(object, "run_heard");
    view.run_number = whole<std::int64_t>(object, "run_number");
    view.run_id = text(object, "run_id");
    view.endpoints = rows(object.member("endpoints"), endpoint);
    view.reports = rows(object.member("reports"), read_report);
    view.activities = rows(object.member("activities"), activity);
    view.refusals = rows(object.member("refusals"), refusal);
    view.aside = rows(object.member("aside"), aside);
    view.budget_mbit = number(object, "budget_mbit");
    view.sent_mbit = number(object, "sent_mbit");
    view.queued_bytes = count(object, "queued_bytes");
    view.attention = rows(object.member("attention"), sentence);
    return view;
  });
}

}  // namespace adit::cli
