#include "page/box_json.hpp"

#include "codec/json.hpp"
#include "page/as_json.hpp"

namespace adit::page {
using codec::Value;

namespace {

Value json(const PartRow& row) {
  return {Value::Object{{"name", page::json(row.name)},
                        {"version", page::json(row.version)},
                        {"licence", page::json(row.licence)}}};
}

Value json(const InterfaceRow& row) {
  Value::Array addresses;
  for (const std::string& address : row.addresses) addresses.push_back(page::json(address));
  return {Value::Object{{"name", page::json(row.name)},
                        {"up", page::json(row.up)},
                        {"carrier", page::json(row.carrier)},
                        {"addresses", {std::move(addresses)}}}};
}

Value json(const RouteRow& row) {
  return {Value::Object{{"destination", page::json(row.destination)},
                        {"gateway", page::json(row.gateway)},
                        {"interface", page::json(row.interface)},
                        {"metric", page::json(row.metric)}}};
}

Value json(const LogRecord& record) {
  Value::Object fields;
  for (const auto& [name, value] : record.fields) fields.emplace_back(name, page::json(value));
  return {Value::Object{{"seq", page::json(record.seq)},
                        {"at", page::json(record.at)},
                        {"level", page::json(record.level)},
                        {"message", page::json(record.message)},
                        {"fields", {std::move(fields)}}}};
}

/// null: the box was not told which one it is.
Value board_of(const About& about) {
  if (about.board.empty()) return {};
  return {Value::Object{{"name", page::json(about.board)}, {"title", page::json(about.board_title)}}};
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
  return codec::write_json({Value::Object{{"version", page::json(about.version)},
                                          {"build", page::json(about.build)},
                                          {"licence", page::json(about.licence)},
                                          {"started", page::json(about.started)},
                                          {"uptime", page::json(now - about.started)},
                                          {"kernel", page::json(about.kernel)},
                                          {"model", page::json(about.model)},
                                          {"board", board_of(about)},
                                          {"parts", rows(about.parts)}}});
}

std::string write_network(const NetworkState& network) {
  return codec::write_json({Value::Object{{"interfaces", rows(network.interfaces)},
                                          {"routes", rows(network.routes)},
                                          {"trouble", page::json(network.trouble)}}});
}

std::string write_log(const std::vector<LogRecord>& records, std::uint64_t last) {
  return codec::write_json({Value::Object{{"last", page::json(last)}, {"records", rows(records)}}});
}

}  // namespace adit::page
