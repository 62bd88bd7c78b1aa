#include "applier/networkd_files.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <utility>
#include <vector>

#include "host/command.hpp"
#include "host/files.hpp"
#include "host/log.hpp"
#include "host/service.hpp"
#include "icd/sentence.hpp"
#include "network/networkd.hpp"

namespace adit::applier {
namespace {

constexpr int kForAll = 0644;

/// "" where it cannot be read.
std::string text_of(const std::string& path) {
  return host::read_file(path).value_or("");
}

}  // namespace

std::array<NetworkdFiles::Place, 2> NetworkdFiles::places() const {
  return {{{.interface = options_.team,
            .tried = options_.tried + '/' + network::kTriedTeam,
            .kept = options_.kept + '/' + network::kKeptTeam,
            .text = ""},
           {.interface = options_.command_post,
            .tried = options_.tried + '/' + network::kTriedCommandPost,
            .kept = options_.kept + '/' + network::kKeptCommandPost,
            .text = ""}}};
}

std::array<NetworkdFiles::Place, 2> NetworkdFiles::places(const network::Numbers& numbers) const {
  auto both = places();
  both[0].text = network::team_file(options_.team, numbers);
  both[0].address = numbers.team.address;
  both[1].text = network::command_post_file(options_.command_post, numbers);
  both[1].address = numbers.command_post.address;
  return both;
}

std::expected<void, std::string> NetworkdFiles::settle() {
  if (const auto text = host::slurp(confirmed_file())) {
    const auto kept = network::read_kept(text->text);
    if (kept) {
      confirmed_ = *kept;
    } else if (auto aside = set_aside(kept.error()); !aside) {
      return aside;
    }
  } else if (text.error() != ENOENT) {
    return std::unexpected(host::trouble(confirmed_file(), text.error()));
  }
  bool changed = false;
  if (confirmed_) {
    const auto written = write_kept(*confirmed_);
    if (!written) return std::unexpected(written.error());
    changed = *written;
  }
  const auto removed = remove_tried();
  if (!removed) return std::unexpected(removed.error());
  found_a_change_ = *removed;
  return changed || *removed ? reload() : std::expected<void, std::string>{};
}

/// What networkd has stays as it is, and a change can be made.
std::expected<void, std::string> NetworkdFiles::set_aside(const std::string& why) const {
  const std::string file = confirmed_file();
  host::log(host::Level::Error, "what was confirmed last is damaged and set aside",
            {{"file", file}, {"why", why}});
  if (rename(file.c_str(), (file + ".damaged").c_str()) == 0) return {};
  return std::unexpected(host::trouble(file, errno));
}

std::expected<void, std::string> NetworkdFiles::apply(const network::Numbers& numbers) {
  std::vector<Place> changes;
  for (Place& place : places(numbers)) {
    const std::string tried = text_of(place.tried);
    if ((tried.empty() ? text_of(place.kept) : tried) != place.text) changes.push_back(std::move(place));
  }
  for (const Place& place : changes) {
    if (auto unused = check_unused(place); !unused) return unused;
  }
  for (const Place& place : changes) {
    if (auto written = host::write_file(place.tried, place.text, kForAll); !written) return written;
  }
  return changes.empty() ? std::expected<void, std::string>{} : reload();
}

/// An interface that is down, or not there yet, has nobody to ask.
std::expected<void, std::string> NetworkdFiles::check_unused(const Place& place) const {
  const auto claim = probe_(place.interface, place.address);
  if (!claim) {
    host::log(host::Level::Warning, "nobody could be asked for an address", {{"why", claim.error()}});
  } else if (*claim) {
    const std::string& own = (*claim)->own;
    return std::unexpected(icd::sentence(settings::ipv4_text(place.address), " is in use already on ",
                                         place.interface, ", by ",
                                         own.empty() ? (*claim)->mac : "this box's own " + own));
  }
  return {};
}

/// What was tried stays where it is until the next start, so that networkd has nothing to do anew. Once
/// confirmed.json is written, the change is kept, whatever happens next: settle() does the rest.
std::expected<void, std::string> NetworkdFiles::keep(const network::Numbers& numbers) {
  if (auto written = host::write_file(confirmed_file(), network::write_kept(numbers), kForAll); !written)
    return written;
  confirmed_ = numbers;
  if (const auto written = write_kept(numbers); !written) {
    host::log(host::Level::Error, "kept, but not for networkd: that is tried again at the next start",
              {{"why", written.error()}});
  }
  return {};
}

std::expected<void, std::string> NetworkdFiles::take_back() {
  const auto removed = remove_tried();
  if (!removed) return std::unexpected(removed.error());
  return *removed || reload_is_due_ ? reload() : std::expected<void, std::string>{};
}

std::expected<bool, std::string> NetworkdFiles::write_kept(const network::Numbers& numbers) const {
  bool changed = false;
  for (const Place& place : places(numbers)) {
    if (text_of(place.kept) == place.text) continue;
    if (const auto written = host::write_file(place.kept, place.text, kForAll); !written) {
      return std::unexpected(written.error());
    }
    changed = true;
  }
  return changed;
}

std::expected<bool, std::string> NetworkdFiles::remove_tried() const {
  bool removed = false;
  for (const Place& place : confirmed_ ? places(*confirmed_) : places()) {
    const auto tried = host::slurp(place.tried);
    if (!tried && tried.error() == ENOENT) continue;
    if (tried && !place.text.empty() && tried->text == place.text) continue;  // this is what was confirmed
    if (unlink(place.tried.c_str()) != 0) return std::unexpected(host::trouble(place.tried, errno));
    removed = true;
  }
  return removed;
}

std::expected<void, std::string> NetworkdFiles::reload() {
  auto reloaded = host::run_command({options_.networkctl, "reload"}, kReload);
  reload_is_due_ = !reloaded;
  return reloaded;
}

}  // namespace adit::applier
