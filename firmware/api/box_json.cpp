#include "api/box_json.hpp"

#include "api/as_json.hpp"
#include "codec/json.hpp"

namespace adit::api {
using codec::Value;

namespace {

Value json(const PartRow& row) {
  return {Value::Object{{"name", api::json(row.name)},
                        {"version", api::json(row.version)},
                        {"licence", api::json(row.licence)}}};
}

Value json(const InterfaceRow& row) {
  Value::Array addresses;
  for (const std::string& address : row.addresses) addresses.push_back(api::json(address));
  return {Value::Object{{"name", api::json(row.name)},
                        {"up", api::json(row.up)},
                        {"carrier", api::json(row.carrier)},
                        {"addresses", {std::move(addresses)}}}};
}

Value json(const RouteRow& row) {
  return {Value::Object{{"destination", api::json(row.destination)},
                        {"gateway", api::json(row.gateway)},
                        {"interface", api::json(row.interface)},
                        {"metric", api::json(row.metric)}}};
}

Value json(const LogRecord& record) {
  Value::Object fields;
  for (const auto& [name, value] : record.fields) fields.emplace_back(name, api::json(value));
  return {Value::Object{{"seq", api::json(record.seq)},
                        {"at", api::json(record.at)},
                        {"level", api::json(record.level)},
                        {"message", api::json(record.message)},
                        {"fields", {std::move(fields)}}}};
}

/// null: the box was not told which one it is.
Value board_of(const About& about) {
  if (about.board.empty()) return {};
  return {Value::Object{{"name", api::json(about.board)}, {"title", api::json(about.board_title)}}};
}

template <class Row>
Value rows(const std::vector<Row>& rows) {
  Value::Array array;
  array.reserve(rows.size());
  for (const Row& row : rows) array.push_back(json(row));
  return {std::move(array)};
}

}  // namespace

std::string write_about(const About& about, Time now) {
  return codec::write_json({Value::Object{{"version", api::json(about.version)},
                                          {"build", api::json(about.build)},
                                          {"licence", api::json(about.licence)},
                                          {"started", api::json(about.started)},
                                          {"uptime", api::json(now - about.started)},
                                          {"kernel", api::json(about.kernel)},
                                          {"model", api::json(about.model)},
                                          {"board", board_of(about)},
                                          {"parts", rows(about.parts)}}});
}

std::string write_network(const NetworkState& network) {
  return codec::write_json({Value::Object{{"interfaces", rows(network.interfaces)},
                                          {"routes", rows(network.routes)},
                                          {"trouble", api::json(network.trouble)}}});
}

std::string write_log(const std::vector<LogRecord>& records, std::uint64_t last) {
  return codec::write_json({Value::Object{{"last", api::json(last)}, {"records", rows(records)}}});
}

}  // namespace adit::api
