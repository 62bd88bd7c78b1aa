#include "box/this_box.hpp"

#include <cJSON.h>
#include <crypt.h>
#include <gnu/libc-version.h>
#include <libdeflate.h>
#include <microhttpd.h>
#include <sodium.h>
#include <zlib.h>

#include <boost/version.hpp>
#include <utility>
#include <vector>

#include "box/build.hpp"
#include "box/version.hpp"
#include "host/interfaces.hpp"
#include "host/log.hpp"
#include "host/process.hpp"
#include "icd/sentence.hpp"
#include "panel/lines.hpp"

namespace adit::box {
namespace {

constexpr const char* kLesserGpl = "LGPL-2.1-or-later";

std::string dotted(int major, int minor, int patch) {
  return icd::sentence(major, ".", minor, ".", patch);
}

std::string boost_version() {
  return dotted(BOOST_VERSION / 100000, BOOST_VERSION / 100 % 1000, BOOST_VERSION % 100);
}

/// Libraries of the program, with versions at run time if known, else of the build.
std::vector<api::PartRow> parts() {
  return {{.name = "libmicrohttpd", .version = MHD_get_version(), .licence = kLesserGpl},
          {.name = "cJSON", .version = cJSON_Version(), .licence = "MIT"},
          {.name = "zlib", .version = zlibVersion(), .licence = "Zlib"},
          {.name = "libdeflate", .version = LIBDEFLATE_VERSION_STRING, .licence = "MIT"},
          {.name = "Boost.Beast", .version = boost_version(), .licence = "BSL-1.0"},
          {.name = "libsystemd", .version = kSystemdVersion, .licence = kLesserGpl},
          {.name = "libgpiod", .version = panel::gpiod_version(), .licence = kLesserGpl},
          {.name = "libcrypt", .version = XCRYPT_VERSION_STR, .licence = kLesserGpl},
          {.name = "libsodium", .version = sodium_version_string(), .licence = "ISC"},
          {.name = "glibc", .version = gnu_get_libc_version(), .licence = kLesserGpl}};
}

/// "9f1c2ab0d3e4, GNU 12.2.0, Release"
std::string build_text() {
  const std::string_view commit = kCommit;
  return icd::sentence(commit, commit.empty() ? "" : ", ", kCompiler, ", ", kBuildType);
}

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
