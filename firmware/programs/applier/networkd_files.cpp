#include "applier/networkd_files.hpp"

#include <unistd.h>

#include <cerrno>
#include <utility>

#include "host/files.hpp"
#include "host/log.hpp"
#include "host/output.hpp"
#include "host/root_program.hpp"
#include "host/service.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"
#include "network/change.hpp"

namespace adit::applier {
namespace {

/// "" if the file is absent.
std::expected<std::string, std::string> text_of(const std::string& path) {
  auto text = ADIT_TRY(host::read_optional_file(path));
  return std::move(text).value_or("");
}

}  // namespace

bool Reload::is_due() const {
  return is_due_ || host::can_exist(file());
}

void Reload::set_due() {
  if (is_due()) return;
  is_due_ = true;
  host::log_failure(host::Level::Error, "cannot note that networkd has to read its files",
                    host::write_file(file(), "", host::kForAll));
}

std::expected<void, std::string> Reload::run() {
  if (!is_due()) return {};
  if (auto read = host::run_command({options_.networkctl, "reload"}, kWithin); !read) return read;
  is_due_ = false;
  return host::remove_file(file());
}

std::array<NetworkdFiles::Place, 2> NetworkdFiles::places() const {
  return {{{.interface = options_.team,
            .tried = options_.networkd + '/' + network::kTriedTeam,
            .kept = options_.networkd + '/' + network::kKeptTeam},
           {.interface = options_.command_post,
            .tried = options_.networkd + '/' + network::kTriedCommandPost,
            .kept = options_.networkd + '/' + network::kKeptCommandPost}}};
}

std::array<NetworkdFiles::Place, 2> NetworkdFiles::places(const network::Numbers& numbers) const {
  auto both = places();
  both[0].text = network::team_file(options_.team, numbers);
  if (numbers.mode == network::Mode::Static) both[0].addresses = {numbers.team.address};
  both[1].text = network::command_post_file(options_.command_post, numbers, endpoints_.addresses);
  for (const settings::Subnet& each : numbers.command_post) both[1].addresses.push_back(each.address);
  return both;
}

std::expected<void, std::string> NetworkdFiles::settle() {
  if (auto read = this->read(); !read) return read;
  if (auto written = write(FollowUp::Reload); !written) return written;
  return reload_.run();
}

std::expected<void, std::string> NetworkdFiles::write_at_start() {
  if (const auto read = this->read(); !read) {
    host::log(host::Level::Error, "cannot read the confirmed addresses: using the initial ones",
              {{"why", read.error()}});
    use_factory();
  }
  return write(FollowUp::Nothing);
}

std::expected<void, std::string> NetworkdFiles::read() {
  const auto confirmed = ADIT_TRY(read_confirmed());
  if (!confirmed) use_factory();
  read_endpoints();
  return {};
}

std::expected<bool, std::string> NetworkdFiles::read_confirmed() {
  const auto text = ADIT_TRY(host::read_optional_file(confirmed_file()));
  if (!text) return false;
  const auto confirmed = network::read_kept(*text);
  if (confirmed) {
    kept_ = *confirmed;
    return true;
  }
  const auto aside = set_aside(confirmed.error());
  return aside ? std::expected<bool, std::string>(false) : std::unexpected(aside.error());
}

/// Uses the factory addresses. If the box came without any, the addresses are set elsewhere and stay.
void NetworkdFiles::use_factory() {
  kept_.reset();
  const auto text = host::read_optional_file(options_.factory);
  if (text && !*text) return;
  const auto factory = text ? network::read_kept(**text) : std::unexpected(text.error());
  if (factory) {
    kept_ = *factory;
  } else {
    host::log(host::Level::Error, "cannot read the initial addresses",
              {{"file", options_.factory}, {"why", factory.error()}});
  }
}

/// If they cannot be read, aditd tells them again.
void NetworkdFiles::read_endpoints() {
  const auto endpoints = host::read_row<network::Endpoints>(endpoints_file());
  if (!endpoints) {
    host::log(host::Level::Error, "cannot read the Command Post's endpoints: no routes until aditd runs",
              {{"why", endpoints.error()}});
  }
  endpoints_ = endpoints && *endpoints ? **endpoints : network::Endpoints{};
}

std::expected<void, std::string> NetworkdFiles::write(FollowUp then) {
  if (kept_) {
    if (auto written = write_kept(*kept_, then); !written) return written;
  }
  const auto removed = ADIT_TRY(remove_tried(then));
  has_unconfirmed_change_ = removed;
  return {};
}

/// A damaged file must not prevent later changes.
std::expected<void, std::string> NetworkdFiles::set_aside(const std::string& why) {
  const std::string file = confirmed_file();
  host::log(host::Level::Error, "the confirmed addresses are damaged: file set aside",
            {{"file", file}, {"why", why}});
  if (rename(file.c_str(), (file + ".damaged").c_str()) == 0) return {};
  return std::unexpected(host::path_error(file, errno));
}

std::expected<void, std::string> NetworkdFiles::apply(const network::Numbers& numbers) {
  std::vector<Place> changes;
  for (Place& place : places(numbers)) {
    const auto in_use = ADIT_TRY(current_text(place));
    if (in_use != place.text) changes.push_back(std::move(place));
  }
  for (const Place& place : changes) {
    if (auto unused = check_unused(place); !unused) return unused;
  }
  tried_ = numbers;
  for (const Place& place : changes) {
    if (auto written = put(place.tried, place.text, FollowUp::Reload); !written) return written;
  }
  return reload_.run();
}

std::expected<std::string, std::string> NetworkdFiles::current_text(const Place& place) {
  auto tried = text_of(place.tried);
  return tried && tried->empty() ? text_of(place.kept) : tried;
}

/// An interface that is down or absent cannot be probed.
std::expected<void, std::string> NetworkdFiles::check_unused(const Place& place) const {
  if (place.addresses.empty()) return {};
  const auto claim = probe_(place.interface, place.addresses);
  if (!claim) {
    host::log(host::Level::Warning, "cannot ask whether an address is in use", {{"why", claim.error()}});
  } else if (*claim) {
    const std::string& own = (*claim)->own;
    return std::unexpected(icd::sentence(settings::ipv4_text((*claim)->address), " is already in use on ",
                                         place.interface, ", by ",
                                         own.empty() ? (*claim)->mac : "this box's own " + own));
  }
  return {};
}

/// The files on trial stay until the next start, so that networkd need not reload. Once confirmed.json is
/// written, the change is stored; settle() finishes the rest.
std::expected<void, std::string> NetworkdFiles::keep(const network::Numbers& numbers) {
  if (auto written = host::write_file(confirmed_file(), network::write_kept(numbers), host::kForAll);
      !written)
    return written;
  kept_ = numbers;
  tried_.reset();
  host::log_failure(host::Level::Error,
                    "addresses stored, but not written for networkd: retry at the next start",
                    write_kept(numbers, FollowUp::Nothing));
  return {};
}

std::expected<void, std::string> NetworkdFiles::revert() {
  (void)ADIT_TRY(remove_tried(FollowUp::Reload));
  tried_.reset();
  return reload_.run();
}

/// Without factory addresses, also removes networkd's files.
std::expected<std::optional<network::Numbers>, std::string> NetworkdFiles::forget() {
  for (const std::string& file : {confirmed_file(), endpoints_file()}) {
    ADIT_TRY(host::remove_file(file));
  }
  endpoints_ = {};
  tried_.reset();
  use_factory();
  reload_.set_due();
  for (const Place& place : places()) {
    if (!kept_ && unlink(place.kept.c_str()) != 0 && errno != ENOENT) {
      return std::unexpected(host::path_error(place.kept, errno));
    }
  }
  ADIT_TRY(write(FollowUp::Reload));
  ADIT_TRY(reload_.run());
  return kept_;
}

std::expected<void, std::string> NetworkdFiles::lead_to(const network::Endpoints& endpoints) {
  if (endpoints == endpoints_ && !reload_.is_due()) return {};
  if (auto kept = host::write_file(endpoints_file(), codec::write_file(endpoints), host::kForAll); !kept)
    return kept;
  endpoints_ = endpoints;
  if (kept_) {
    if (auto written = write_kept(*kept_, FollowUp::Reload); !written) return written;
  }
  const auto& in_use = tried_ ? tried_ : kept_;
  for (const Place& place : in_use ? places(*in_use) : std::array<Place, 2>{}) {
    const auto used = ADIT_TRY(current_text(place));
    if (used == place.text) continue;
    if (auto written = put(place.tried, place.text, FollowUp::Reload); !written) return written;
  }
  return reload_.run();
}

std::expected<void, std::string> NetworkdFiles::write_kept(const network::Numbers& numbers, FollowUp then) {
  for (const Place& place : places(numbers)) {
    if (const auto text = text_of(place.kept); text && *text == place.text) continue;
    if (auto written = put(place.kept, place.text, then); !written) return written;
  }
  return {};
}

std::expected<void, std::string> NetworkdFiles::put(const std::string& file, const std::string& text,
                                                    FollowUp then) {
  if (then == FollowUp::Reload) reload_.set_due();
  return host::write_file(file, text, host::kForAll);
}

std::expected<bool, std::string> NetworkdFiles::remove_tried(FollowUp then) {
  bool removed = false;
  for (const Place& place : kept_ ? places(*kept_) : places()) {
    const auto tried = host::slurp(place.tried);
    if (!tried && tried.error() == ENOENT) continue;
    if (tried && !place.text.empty() && tried->text == place.text) continue;  // equals the confirmed one
    if (then == FollowUp::Reload) reload_.set_due();
    if (unlink(place.tried.c_str()) != 0) return std::unexpected(host::path_error(place.tried, errno));
    removed = true;
  }
  return removed;
}

}  // namespace adit::applier
