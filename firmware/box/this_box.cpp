#include "box/this_box.hpp"

#include <utility>

#include "box/parts.hpp"
#include "box/version.hpp"
#include "host/interfaces.hpp"
#include "host/log.hpp"
#include "host/process.hpp"

namespace adit::box {
namespace {

api::LogRecord row_of(const host::Record& record) {
  api::LogRecord row{.seq = record.seq,
                     .at = record.at,
                     .severity = static_cast<int>(record.level),
                     .level = std::string(host::name_of(record.level)),
                     .message = host::escaped(record.message),
                     .fields = {},
                     .line = host::line_of(record)};
  row.fields.reserve(record.fields.size());
  for (const auto& [name, value] : record.fields) row.fields.emplace_back(name, host::escaped(value));
  return row;
}

}  // namespace

ThisBox::ThisBox(const loop::Loop& loop, loop::Workers& workers, settings::Board board, std::string settings,
                 std::function<void(api::Usage&)> add_to)
    : loop_(loop),
      workers_(workers),
      board_(std::move(board)),
      settings_(std::move(settings)),
      add_to_(std::move(add_to)) {}

api::Time ThisBox::started() const {
  return loop_.wall_now() - host::process().age_seconds;
}

std::vector<api::LogRecord> ThisBox::log(std::uint64_t after) const {
  std::vector<api::LogRecord> rows;
  for (const host::Record& record : host::remembered(after)) rows.push_back(row_of(record));
  return rows;
}

std::uint64_t ThisBox::logged() const {
  return host::logged();
}

api::Usage ThisBox::usage() const {
  const host::Process process = host::process();
  api::Usage usage{.started = started(),
                   .cpu_seconds = process.cpu_seconds,
                   .resident_bytes = process.resident_bytes,
                   .open_files = process.open_files,
                   .most_files = process.most_files,
                   .threads = process.threads,
                   .refused = {}};
  add_to_(usage);
  return usage;
}

api::About ThisBox::about() const {
  return {
      .version = kVersion,
      .build = build_text(),
      .licence = "Apache-2.0",
      .started = started(),
      .kernel = host::kernel(),
      .model = host::model(),
      .board = board_.name.empty() ? std::nullopt : std::optional(api::BoardRow{board_.name, board_.title}),
      .parts = parts()};
}

api::NetworkState ThisBox::network() const {
  api::NetworkState state;
  const auto interfaces = host::interfaces();
  if (!interfaces) state.trouble = interfaces.error();
  for (const host::Interface& each : interfaces.value_or(std::vector<host::Interface>{})) {
    state.interfaces.push_back(
        {.name = each.name, .up = each.up, .carrier = each.carrier, .addresses = each.addresses});
  }
  for (const host::Route& each : host::routes()) {
    state.routes.push_back({.destination = each.destination,
                            .gateway = each.gateway,
                            .interface = each.interface,
                            .metric = each.metric});
  }
  return state;
}

void ThisBox::work(std::function<void()> work, std::function<void()> done) {
  workers_.submit(loop::Urgency::CanWait, std::move(work), std::move(done),
                  [] {});  // waiting objects are destroyed unanswered
}

}  // namespace adit::box
