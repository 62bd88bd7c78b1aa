// The scoring endpoint's messages (ICD 5).
#include <algorithm>

#include "codec/field.hpp"
#include "codec/json.hpp"
#include "codec/members.hpp"
#include "codec/read.hpp"
#include "icd/members.hpp"
#include "icd/suggestion.hpp"
#include "icd/try.hpp"

namespace adit::codec {
namespace {

constexpr std::size_t kLongestUnknownType = 64;

/// A type outside the ICD's ten that may be forwarded if the settings allow it.
bool is_forwardable(std::string_view type) {
  const auto printable = [](char letter) { return letter >= 0x20 && letter < 0x7f; };
  return !type.empty() && type.size() <= kLongestUnknownType && std::ranges::all_of(type, printable);
}

std::string_view read_type(const Field& field, const icd::Rules& rules) {
  const std::string_view type = field.text();
  if (!icd::artifact_type(type).empty()) return type;
  if (!rules.forward_unknown_types) {
    std::string ten;
    for (const auto known : icd::kArtifactTypes) ten += icd::sentence(known, ", ");
    // Names the setting only if there is no hint, because it would waste a report on a misspelt type.
    std::string cure = icd::type_hint(type);
    const bool is_curable = cure.empty() && is_forwardable(type);
    if (is_curable) cure = " (the setting rules.forward_unknown_types accepts others)";
    field.refuse_by_setting(is_curable ? "rules.forward_unknown_types" : "", "expected one of ", ten, "got ",
                            icd::quote_text(type), cure);
  } else if (!is_forwardable(type)) {
    field.refuse("expected 1 to ", kLongestUnknownType, " printable ASCII characters, got ",
                 icd::quote_text(type));
  }
  return type;
}

/// Applies `read` to a reply's fields. The error is a sentence.
template <class Message>
std::expected<Message, std::string> read_reply(std::string_view json, Message (*read)(const Field&)) {
  const auto root = ADIT_TRY(parse_json(json));
  Reading reading;
  auto message = reading.outcome(read(Field(root, reading)));
  if (!message) return std::unexpected(std::move(message.error().sentence));
  return *std::move(message);
}

/// A string, or a number as text, or "".
std::string read_name(const Field& field) {
  if (field.is<std::string>()) return std::string(field.text());
  if (field.is<std::int64_t>()) return std::to_string(field.integer<std::int64_t>());
  if (field.is<double>()) return icd::number_text(field.number());
  return {};
}

bool has_number(const Field& field) {
  return field.is<double>() || field.is<std::int64_t>() || field.is<std::uint64_t>();
}

/// Uses its own Reading, because an invalid name does not refuse the report.
icd::Checked<std::optional<icd::RobotName>> read_robot(const Document& document, const icd::Rules& rules) {
  Reading reading;
  const Field body(document.root, reading);
  const Field name = body.member("name");
  return reading.outcome(name.is_absent() ? std::nullopt : read_robot_name(name, rules));
}

icd::RunStatus status_of(const Field& body) {
  static_assert(icd::count_of_members<icd::RunStatus>() == 4, "read each member");
  icd::RunStatus status;
  status.score = body.member("score").integer<std::int32_t>();
  const Field run_clock = body.member("run_clock");
  const Field clock = body.member("clock");
  status.run_clock = run_clock.is_absent() && !clock.is_absent() ? clock.number() : run_clock.number();
  status.remaining_reports = body.member("remaining_reports").integer<std::int32_t>();
  status.current_team = read_name(body.member("current_team"));
  return status;
}

/// The report in a reply, if complete.
std::optional<icd::ArtifactReport> report_in(const Field& body) {
  const Field type = body.member("type"), x = body.member("x"), y = body.member("y"), z = body.member("z");
  if (!type.is<std::string>() || !has_number(x) || !has_number(y) || !has_number(z)) return std::nullopt;
  return icd::ArtifactReport{.type = std::string(type.text()),
                             .position = {x.number(), y.number(), z.number()}};
}

icd::ReportReply reply_of(const Field& body) {
  icd::ReportReply reply;
  reply.run = read_name(body.member("run"));
  if (const Field clock = body.member("run_clock"); has_number(clock)) reply.run_clock = clock.number();
  reply.report_status = body.member("report_status").text();
  reply.score_change = body.member("score_change").integer<std::int32_t>();
  reply.report = report_in(body);
  return reply;
}

}  // namespace

icd::Checked<ReadReport> read_artifact_report(const Document& document, const icd::Rules& rules) {
  static_assert(icd::count_of_members<icd::ArtifactReport>() == 3, "read each member");
  Reading reading;
  ReadReport read;
  const Field body(document.root, reading);
  read_members(body, read.report.position, rules);
  read.report.type = read_type(body.member("type"), rules);
  auto robot = read_robot(document, rules);
  if (robot) {
    read.report.robot = *std::move(robot);
  } else {
    read.left_out = std::move(robot.error().sentence);
  }
  return reading.outcome(std::move(read));
}

std::expected<icd::RunStatus, std::string> read_run_status(std::string_view json) {
  return read_reply(json, status_of);
}

std::expected<icd::ReportReply, std::string> read_report_reply(std::string_view json) {
  return read_reply(json, reply_of);
}

}  // namespace adit::codec
