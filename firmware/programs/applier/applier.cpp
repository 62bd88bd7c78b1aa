#include "applier/applier.hpp"

#include <sys/epoll.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "applier/arp.hpp"
#include "host/interfaces.hpp"
#include "host/log.hpp"
#include "host/service.hpp"
#include "icd/try.hpp"
#include "network/messages.hpp"

namespace adit::applier {

using host::Level;

Applier::Applier(loop::Loop& loop, const Options& options)
    : loop_(loop),
      options_(options),
      files_(options),
      file_(options.status + '/' + host::kStatusFile),
      due_(loop.timer([this] { poll(); })) {}

std::expected<void, std::string> Applier::start() {
  const auto before = file_.read_earlier<network::Status>();
  if (auto settled = files_.settle(); !settled) {
    network::Status status = before.value_or(network::Status{});
    status.team_interface = options_.team;
    status.command_post_interface = options_.command_post;
    status.trouble = settled.error();
    (void)file_.write(status);  // a failure is logged
    return settled;
  }
  change_.emplace(files_, files_.confirmed_numbers());
  change_->set_endpoints(files_.endpoints());
  change_->set_interfaces(options_.team, options_.command_post);
  // Or an earlier start found the change and could not make networkd read its files.
  const bool was_pending = before && before->pending && before->pending->wanted != files_.confirmed_numbers();
  if (files_.has_unconfirmed_change() || was_pending) {
    host::log(Level::Warning, "a change that was not confirmed was reverted");
    change_->on_interrupted();
  }
  if (!write_status()) return std::unexpected("cannot write the status");
  auto folder = ADIT_TRY(host::open_requests(options_.wanted));
  folder_ = std::move(folder);
  if (folder_) watch_folder();
  if (folder_ && (!before || !before->trouble.empty())) drop_requests();
  poll();
  return {};
}

void Applier::stop() {
  if (folder_) handle_word();
  change_->stop(loop_.now());
  write_status();
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
    poll();
  });
}

/// Reads requests before tick(), so that a confirmation that came during slow work is still in time.
void Applier::poll() {
  if (folder_) handle_requests();
  change_->tick(loop_.now());
  write_status();
  if (folder_) handle_probe();
  run_after_requests();
}

/// Removes requests of an earlier boot, except requests that remain valid.
void Applier::drop_requests() {
  for (const char* name : {network::kWantedFile, network::kWordFile, network::kProbeFile}) remove(name);
}

void Applier::handle_requests() {
  if (!handle_forget()) return;
  handle_endpoints();
  handle_wanted();
  handle_word();
}

template <class Request>
std::optional<Request> Applier::read_request(const char* name) {
  auto request = host::take_request<Request>(*folder_, name);
  if (request) return *std::move(request);
  on_stuck_request(request.error());
  return std::nullopt;
}

void Applier::remove(const char* name) {
  if (const auto removed = folder_->remove(name); !removed) on_stuck_request(removed.error());
}

void Applier::on_stuck_request(const std::string& why) {
  is_stuck_ = true;
  host::log(Level::Error, "cannot take a request", {{"why", why}});
}

void Applier::handle_wanted() {
  const auto wanted = read_request<network::ChangeRequest>(network::kWantedFile);
  if (!wanted) return;
  host::log(Level::Notice, "change requested",
            {{"team", network::team_text(wanted->numbers)},
             {"command_post", network::command_post_text(wanted->numbers)}});
  change_->request_change(*wanted, loop_.now());
}

void Applier::handle_word() {
  if (const auto word = read_request<network::Decision>(network::kWordFile))
    change_->decide(*word, loop_.now());
}

void Applier::handle_probe() {
  if (const auto probe = read_request<network::Probe>(network::kProbeFile)) answer_probe(*probe);
}

/// Removes the request only after it is done, so that a power cut repeats it. False: not done.
bool Applier::handle_forget() {
  const auto text = folder_->read(network::kForgetFile);
  if (text && !*text) return true;
  if (text && !forget(**text)) {
    is_stuck_ = true;
    return false;
  }
  remove(network::kForgetFile);
  return true;
}

/// Returns true if the request is finished.
bool Applier::forget(const std::string& text) {
  if (const auto forget = codec::read_file<network::FactoryRequest>(text); !forget) {
    host::log_rejected_request(network::kForgetFile, forget.error());
    return true;
  }
  if (const auto forgotten = change_->forget(loop_.now()); !forgotten) {
    host::log(Level::Error, "cannot forget the addresses", {{"why", forgotten.error()}});
    return false;
  }
  host::log(Level::Notice, "the initial addresses are in use");
  return true;
}

void Applier::handle_endpoints() {
  const auto endpoints = read_request<network::Endpoints>(network::kEndpointsFile);
  if (!endpoints) return;
  if (const auto done = files_.lead_to(*endpoints); !done) {
    return host::log(Level::Error, "cannot set the routes to the endpoints", {{"why", done.error()}});
  }
  change_->set_endpoints(*endpoints);
}

void Applier::answer_probe(const network::Probe& probe) {
  network::ProbeResult probed{.nonce = probe.nonce};
  std::vector<std::uint32_t> own;
  if (const auto all = host::own_addresses(options_.command_post); !all) {
    probed.trouble = all.error();
  } else {
    for (const settings::Subnet& each : *all) own.push_back(each.address);
  }
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
  if (const auto sought = settings::ipv4_of(probe.sought)) find_address(*sought, probed);
  host::log_failure(Level::Error, "cannot write an answer",
                    host::write_file(options_.status + '/' + network::kProbedFile, codec::write_file(probed),
                                     host::kForAll));
}

/// Finds the interface on which a machine answers for an address.
void Applier::find_address(std::uint32_t address, network::ProbeResult& probed) const {
  for (const std::string& interface : {options_.command_post, options_.team}) {
    const auto claim = applier::probe(interface, {address});
    if (!claim) {
      probed.not_sought = claim.error();
    } else if (*claim) {
      probed.found_on = interface;
      return;
    }
  }
}

/// Writes the status if it has changed. False: cannot write.
bool Applier::write_status() {
  const network::Status& status = change_->status();
  const auto told = file_.write(status);
  if (!told || !*told) return told.has_value();
  if (status.pending) {
    host::log(Level::Notice, "change applied: confirm it");
  } else if (status.ended != network::ChangeOutcome::NotYet) {
    host::log(Level::Notice, "change ended",
              {{"how", std::string(name_of(status.ended))}, {"why", status.why}});
  }
  return true;
}

void Applier::run_after_requests() {
  if (const auto wake = change_->wake()) {
    due_.call_at(*wake);
  } else {
    loop_.stop();
  }
}

}  // namespace adit::applier
