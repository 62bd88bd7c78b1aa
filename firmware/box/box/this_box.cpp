#include "box/this_box.hpp"

#include <cJSON.h>
#include <crypt.h>
#include <gnu/libc-version.h>
#include <libdeflate.h>
#include <microhttpd.h>
#include <sodium.h>
#include <sys/epoll.h>
#include <zlib.h>

#include <algorithm>
#include <boost/version.hpp>
#include <utility>
#include <vector>

#include "box/build.hpp"
#include "box/version.hpp"
#include "host/interfaces.hpp"
#include "host/log.hpp"
#include "host/process.hpp"
#include "host/root_program.hpp"
#include "host/service.hpp"
#include "icd/sentence.hpp"
#include "panel/lines.hpp"

namespace adit::box {

Links::Links(loop::Loop& loop, const settings::Settings& settings, CarrierReader look,
             loop::FileDescriptor kernel, std::function<void()> changed, std::function<void()> back)
    : look_(std::move(look)),
      changed_(std::move(changed)),
      back_(std::move(back)),
      links_{{{.side = "team", .interface = settings.team.interface},
              {.side = "command_post", .interface = settings.command_post.interface}}},
      kernel_(std::move(kernel)) {
  if (kernel_) {
    told_ = loop.watch(kernel_.get(), EPOLLIN, [this](std::uint32_t) {
      if (!host::take_link_changes(kernel_)) told_.wait_for(0);
      this->refresh();
    });
  }
  for (Link& link : links_) link.carrier = look_(link.interface);
}

void Links::watch_settings(const settings::Settings& settings) {
  const std::string* const interfaces[] = {&settings.team.interface, &settings.command_post.interface};
  for (std::size_t i = 0; i < links_.size(); ++i) {
    if (links_[i].interface == *interfaces[i]) continue;
    links_[i].interface = *interfaces[i];
    links_[i].carrier = look_(links_[i].interface);
  }
}

void Links::refresh() {
  bool changed = false, back = false;
  for (Link& link : links_) {
    const auto before = std::exchange(link.carrier, look_(link.interface));
    if (link.carrier == before) continue;
    changed = true;
    const bool is_up = link.carrier.value_or(false);
    back = back || (is_up && &link == &links_.back());
    host::log(is_up ? host::Level::Notice : host::Level::Warning,
              is_up ? "cable connected" : "cable disconnected", {{"interface", link.interface}});
  }
  if (changed) changed_();
  if (back) back_();
}

std::vector<facts::LinkRow> Links::rows() const {
  std::vector<facts::LinkRow> rows;
  for (const Link& link : links_) {
    if (!link.interface.empty())
      rows.push_back({.side = link.side, .interface = link.interface, .carrier = link.carrier});
  }
  return rows;
}

namespace {

constexpr std::size_t kMostNotices = 8, kLongestNotice = 500;

}  // namespace

KnownBoard read_board(const std::string& file) {
  if (file.empty() || !host::can_exist(file)) return {};
  const auto text = host::read_file(file);
  auto board =
      text ? settings::parse_board(*text) : std::unexpected(std::vector<settings::Error>{{"", text.error()}});
  if (board) return {std::move(*board), ""};
  std::string trouble =
      "cannot read the board's description: " + file + ": " + settings::sentence_of(board.error());
  host::log(host::Level::Error, trouble);
  return {{}, std::move(trouble)};
}

std::map<std::string, std::string> read_notices(const std::string& folder) {
  std::map<std::string, std::string> notices;
  const auto names = host::names_in(folder);
  if (!names) notices.emplace("notices", "cannot list " + folder + ": " + names.error());
  for (const std::string& name : names.value_or(std::vector<std::string>())) {
    const auto text = host::read_optional_file(folder + '/' + name);
    const std::string said = text ? text->value_or("") : "cannot read " + text.error();
    const std::string line = said.substr(0, std::min(said.find('\n'), kLongestNotice));
    if (!line.empty() && notices.size() < kMostNotices) notices.emplace(name, line);
  }
  return notices;
}

namespace {

constexpr const char* kLesserGpl = "LGPL-2.1-or-later";

std::string version_text(int major, int minor, int patch) {
  return icd::sentence(major, ".", minor, ".", patch);
}

std::string boost_version() {
  return version_text(BOOST_VERSION / 100000, BOOST_VERSION / 100 % 1000, BOOST_VERSION % 100);
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
                     .message = host::escape(record.message),
                     .fields = {},
                     .line = host::line_of(record)};
  row.fields.reserve(record.fields.size());
  for (const auto& [name, value] : record.fields) row.fields.emplace_back(name, host::escape(value));
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

api::Time ThisBox::start_time() const {
  return loop_.wall_now() - host::process().age_seconds;
}

std::vector<api::LogRecord> ThisBox::log(std::uint64_t after) const {
  std::vector<api::LogRecord> rows;
  for (const host::Record& record : host::records_after(after)) rows.push_back(row_of(record));
  return rows;
}

std::uint64_t ThisBox::last_record_number() const {
  return host::last_record_number();
}

api::Usage ThisBox::usage() const {
  const host::Process process = host::process();
  api::Usage usage{.started = start_time(),
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
      .started = start_time(),
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
