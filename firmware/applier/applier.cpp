#include "applier/applier.hpp"

#include <sys/epoll.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "applier/arp_probe.hpp"
#include "host/interfaces.hpp"
#include "host/log.hpp"
#include "host/service.hpp"
#include "network/messages.hpp"

namespace adit::applier {
namespace {

using host::Level;

void refused(const char* file, const std::string& why) {
  host::log(Level::Warning, "request rejected", {{"file", file}, {"why", why}});
}

}  // namespace

Applier::Applier(loop::Loop& loop, const Options& options)
    : loop_(loop),
      options_(options),
      files_(options),
      file_(options.status + '/' + network::kStatusFile),
      due_(loop.timer([this] { look(); })) {}

std::expected<void, std::string> Applier::start() {
  const bool first = access((options_.status + '/' + network::kStatusFile).c_str(), F_OK) != 0;
  if (auto settled = files_.settle(); !settled) return settled;
  change_.emplace(files_, files_.kept());
  change_->set_endpoints(files_.endpoints());
  change_->set_interfaces(options_.team, options_.command_post);
  if (found_a_change()) {
    host::log(Level::Warning, "a change that was not confirmed was reverted");
    change_->interrupted();
  }
  auto folder = host::UntrustedFolder::open(options_.wanted);
  if (folder) {
    folder_ = std::move(*folder);
    watch_folder();
    if (first) drop_requests();
  } else {
    host::log(Level::Info, "no requests: cannot open their directory", {{"why", folder.error()}});
  }
  if (!tell()) return std::unexpected("cannot write the status");
  look();
  return {};
}

/// Or the start before this one found it, and could not tell networkd.
bool Applier::found_a_change() const {
  const auto text = host::read_file(options_.status + '/' + network::kStatusFile);
  const auto told = network::read<network::Status>(text.value_or(""));
  const bool was_pending = told && told->pending && told->pending->wanted != files_.kept();
  return files_.found_a_change() || was_pending;
}

void Applier::stop() {
  if (folder_) take_word();
  change_->stop(loop_.now());
  tell();
  loop_.stop();
}

void Applier::watch_folder() {
  notices_ = loop::FileDescriptor(inotify_init1(IN_NONBLOCK | IN_CLOEXEC));
  if (!notices_ ||
      inotify_add_watch(notices_.get(), folder_->path_by_descriptor().c_str(), IN_MOVED_TO) < 0) {
    host::log(Level::Error, "cannot watch for requests while a change is pending",
              {{"why", std::strerror(errno)}});
    return;
  }
  noticed_ = loop_.watch(notices_.get(), EPOLLIN, [this](std::uint32_t) {
    char events[4096];
    while (read(notices_.get(), events, sizeof events) > 0) {
    }
    look();
  });
}

/// Whatever takes its seconds, a word that came meanwhile is heard before the time is up.
void Applier::look() {
  if (folder_) take_requests();
  change_->tick(loop_.now());
  tell();
  if (folder_) take_probe();
  after();
}

/// But for those that are as right now as they were then.
void Applier::drop_requests() {
  for (const char* name : {network::kWantedFile, network::kWordFile, network::kProbeFile}) taken(name);
}

void Applier::take_requests() {
  if (!take_forget()) return;
  take_endpoints();
  take_wanted();
  take_word();
}

template <class Request>
std::optional<Request> Applier::asked(const char* name) {
  const auto text = taken(name);
  if (!text) return std::nullopt;
  auto request = network::read<Request>(*text);
  if (request) return *std::move(request);
  refused(name, request.error());
  return std::nullopt;
}

void Applier::take_wanted() {
  const auto wanted = asked<network::Wanted>(network::kWantedFile);
  if (!wanted) return;
  host::log(Level::Notice, "change requested",
            {{"team", network::team_text(wanted->numbers)},
             {"command_post", network::command_post_text(wanted->numbers)}});
  change_->want(*wanted, loop_.now());
}

void Applier::take_word() {
  if (const auto word = asked<network::Word>(network::kWordFile)) change_->hear(*word, loop_.now());
}

void Applier::take_probe() {
  if (const auto probe = asked<network::Probe>(network::kProbeFile)) answer_probe(*probe);
}

/// Taken away once it is done: after a power cut before that it is done again. False: it is not done.
bool Applier::take_forget() {
  const auto text = folder_->read(network::kForgetFile);
  if (text && !*text) return true;
  if (text && !forget(**text)) {
    is_stuck_ = true;
    return false;
  }
  taken(network::kForgetFile);
  return true;
}

/// Whether there is nothing more to do about it.
bool Applier::forget(const std::string& text) {
  if (const auto forget = network::read<network::Forget>(text); !forget) {
    refused(network::kForgetFile, forget.error());
    return true;
  }
  if (const auto forgotten = change_->forget(loop_.now()); !forgotten) {
    host::log(Level::Error, "cannot forget the addresses", {{"why", forgotten.error()}});
    return false;
  }
  host::log(Level::Notice, "the initial addresses are in use");
  return true;
}

void Applier::take_endpoints() {
  const auto endpoints = asked<network::Endpoints>(network::kEndpointsFile);
  if (!endpoints) return;
  if (const auto done = files_.lead_to(*endpoints); !done) {
    return host::log(Level::Error, "cannot set the routes to the endpoints", {{"why", done.error()}});
  }
  change_->set_endpoints(*endpoints);
}

std::optional<std::string> Applier::taken(const char* name) {
  auto text = folder_->take(name);
  if (text) return std::move(*text);
  is_stuck_ = is_stuck_ || text.error().stays;
  host::log(text.error().stays ? Level::Error : Level::Warning, "request rejected",
            {{"why", text.error().why}});
  return std::nullopt;
}

void Applier::answer_probe(const network::Probe& probe) {
  network::Probed probed{.nonce = probe.nonce};
  std::vector<std::uint32_t> own;
  for (const settings::Subnet& each : host::own_addresses(options_.command_post)) own.push_back(each.address);
  if (!own.empty()) {
    probed.address = settings::ipv4_text(own.front());
    const auto claim = applier::probe(options_.command_post, own);
    if (!claim) {
      probed.trouble = claim.error();
    } else if (*claim) {
      probed.address = settings::ipv4_text((*claim)->address);
      probed.claimant = (*claim)->mac;
      probed.own = (*claim)->own;
    }
  }
  if (const auto sought = settings::ipv4_of(probe.sought)) probed.found_on = side_of(*sought);
  const auto written =
      host::write_file(options_.status + '/' + network::kProbedFile, network::write(probed), host::kForAll);
  if (!written) host::log(Level::Error, "cannot write an answer", {{"why", written.error()}});
}

/// The interface on which somebody answers for an address; "": nobody does, or nobody can be asked.
std::string Applier::side_of(std::uint32_t address) const {
  for (const std::string& interface : {options_.command_post, options_.team}) {
    const auto claim = applier::probe(interface, {address});
    if (claim && *claim) return interface;
  }
  return "";
}

/// The status, where it is another than was told last.
bool Applier::tell() {
  const network::Status& status = change_->status();
  const auto told = file_.tell(network::write(status));
  if (!told || !*told) return told.has_value();
  if (status.pending) {
    host::log(Level::Notice, "change applied: confirm it");
  } else if (status.ended != network::Ended::NotYet) {
    host::log(Level::Notice, "change ended",
              {{"how", std::string(name_of(status.ended))}, {"why", status.why}});
  }
  return true;
}

void Applier::after() {
  if (const auto wake = change_->wake()) {
    due_.call_at(*wake);
  } else {
    loop_.stop();
  }
}

}  // namespace adit::applier
