#include "api/run_view.hpp"

#include "api/as_json.hpp"
#include "codec/json.hpp"

namespace adit::api {
using codec::Value;

Value json(const icd::RunStatus& run) {
  return {Value::Object{{"score", json(run.score)},
                        {"run_clock", json(run.run_clock)},
                        {"remaining_reports", json(run.remaining_reports)},
                        {"current_team", json(run.current_team)}}};
}

Value json(const EndpointRow& row) {
  return {Value::Object{{"name", json(row.name)},
                        {"address", json(row.address)},
                        {"connected", json(row.connected)},
                        {"trouble", json(row.trouble)},
                        {"last_status", json(row.last_status)},
                        {"answer_ms", json(row.answer_ms)},
                        {"throttled", json(row.throttled)},
                        {"foreign", json(row.foreign)}}};
}

Value json(const AsideRow& row) {
  return {Value::Object{{"number", json(row.number)},
                        {"kind", json(row.kind)},
                        {"robot", json(row.robot)},
                        {"at", json(row.at)},
                        {"status", json(row.status)},
                        {"why", json(row.why)},
                        {"bytes", json(row.bytes)},
                        {"overtaken", json(row.overtaken)}}};
}

Value json(const RobotRow& row) {
  return {Value::Object{{"name", json(row.name)},
                        {"position", json(row.position)},
                        {"heading", json(row.heading)},
                        {"at", json(row.at)}}};
}

Value json(const ActivityRow& row) {
  return {Value::Object{{"kind", json(row.kind)},
                        {"robot", json(row.robot)},
                        {"accepted", json(row.accepted)},
                        {"forwarded", json(row.forwarded)},
                        {"replaced", json(row.replaced)},
                        {"merged", json(row.merged)},
                        {"throttled", json(row.throttled)},
                        {"failed", json(row.failed)},
                        {"refused_upstream", json(row.refused_upstream)},
                        {"waiting", json(row.waiting)},
                        {"last_accepted", json(row.last_accepted)},
                        {"last_forwarded", json(row.last_forwarded)},
                        {"bytes_received", json(row.bytes_received)},
                        {"bytes_sent", json(row.bytes_sent)},
                        {"last_status", json(row.last_status)},
                        {"last_sentence", json(row.last_sentence)}}};
}

Value json(const RefusalRow& row) {
  return {Value::Object{{"at", json(row.at)},
                        {"uri", json(row.uri)},
                        {"sender", json(row.sender)},
                        {"status", json(row.status)},
                        {"sentence", json(row.sentence)},
                        {"parts", json(row.parts)}}};
}

Value json(const LightRow& row) {
  return {Value::Object{{"name", json(row.name)}, {"pattern", json(row.pattern)}}};
}

Value json(const LinkRow& row) {
  return {Value::Object{
      {"side", json(row.side)}, {"interface", json(row.interface)}, {"carrier", json(row.carrier)}}};
}

std::string write_run_view(const RunView& view) {
  return codec::write_json({Value::Object{{"now", json(view.now)},
                                          {"version", json(view.version)},
                                          {"run", json(view.run)},
                                          {"run_heard", json(view.run_heard)},
                                          {"run_number", json(view.run_number)},
                                          {"run_id", json(view.run_id)},
                                          {"endpoints", json(view.endpoints)},
                                          {"robots", json(view.robots)},
                                          {"reports", json(view.reports)},
                                          {"near_metres", json(view.near_metres)},
                                          {"activities", json(view.activities)},
                                          {"refusals", json(view.refusals)},
                                          {"aside", json(view.aside)},
                                          {"lights", json(view.lights)},
                                          {"links", json(view.links)},
                                          {"identify_until", json(view.identify_until)},
                                          {"setup_open_until", json(view.setup_open_until)},
                                          {"budget_mbit", json(view.budget_mbit)},
                                          {"sent_mbit", json(view.sent_mbit)},
                                          {"queued_bytes", json(view.queued_bytes)},
                                          {"map_version", json(view.map_version)},
                                          {"marker_version", json(view.marker_version)},
                                          {"attention", json(view.attention)}}});
}

}  // namespace adit::api
