#include "applier/applier.hpp"

#include <sys/epoll.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "applier/arp_probe.hpp"
#include "host/log.hpp"
#include "host/own_address.hpp"
#include "host/service.hpp"
#include "network/messages.hpp"

namespace adit::applier {
namespace {

using host::Level;

constexpr int kForAll = 0644;

}  // namespace

Applier::Applier(loop::Loop& loop, const Options& options)
    : loop_(loop), options_(options), files_(options), due_(loop.timer([this] { look(); })) {}

std::expected<void, std::string> Applier::start() {
  const bool first = access((options_.status + '/' + network::kStatusFile).c_str(), F_OK) != 0;
  if (auto settled = files_.settle(); !settled) return settled;
  change_.emplace(files_, files_.confirmed());
  change_->set_interfaces(options_.team, options_.command_post);
  if (files_.found_a_change()) {
    host::log(Level::Warning, "a change that nobody had confirmed was taken back");
    change_->interrupted();
  }
  auto folder = host::UntrustedFolder::open(options_.wanted);
  if (folder) {
    folder_ = std::move(*folder);
    watch_folder();
    take_requests(first);
  } else {
    host::log(Level::Info, "nobody asks for anything", {{"why", folder.error()}});
  }
  if (!tell()) return std::unexpected("the status cannot be told");
  after();
  return {};
}

void Applier::stop() {
  change_->stop(loop_.now());
  tell();
  loop_.stop();
}

void Applier::watch_folder() {
  notices_ = loop::FileDescriptor(inotify_init1(IN_NONBLOCK | IN_CLOEXEC));
  if (!notices_ ||
      inotify_add_watch(notices_.get(), folder_->path_by_descriptor().c_str(), IN_MOVED_TO) < 0) {
    host::log(Level::Error, "what aditd asks for is not noticed while a change is pending",
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

void Applier::look() {
  change_->tick(loop_.now());
  take_requests(false);
  tell();
  after();
}

/// `drop`: they are taken away and not done.
void Applier::take_requests(bool drop) {
  const auto wanted_text = taken(network::kWantedFile), word_text = taken(network::kWordFile),
             probe_text = taken(network::kProbeFile);
  if (drop) return;
  const auto refuse = [](const char* file, const std::string& why) {
    host::log(Level::Warning, "refused what was asked for", {{"file", file}, {"why", why}});
  };
  if (wanted_text) {
    if (const auto wanted = network::read_wanted(*wanted_text)) {
      host::log(Level::Notice, "asked for a change",
                {{"team", network::host_text(wanted->numbers.team)},
                 {"command_post", network::host_text(wanted->numbers.command_post)}});
      change_->want(*wanted, loop_.now());
    } else {
      refuse(network::kWantedFile, wanted.error());
    }
  }
  if (word_text) {
    if (const auto word = network::read_word(*word_text)) {
      change_->hear(*word, loop_.now());
    } else {
      refuse(network::kWordFile, word.error());
    }
  }
  if (probe_text) {
    tell();  // before the seconds that it takes
    if (const auto probe = network::read_probe(*probe_text)) {
      answer_probe(*probe);
    } else {
      refuse(network::kProbeFile, probe.error());
    }
  }
}

std::optional<std::string> Applier::taken(const char* name) {
  auto text = folder_->take(name);
  if (text) return std::move(*text);
  host::log(Level::Warning, "refused what was asked for", {{"why", text.error()}});
  return std::nullopt;
}

void Applier::answer_probe(const network::Probe& probe) {
  network::Probed probed{.nonce = probe.nonce};
  if (const auto own = host::own_address(options_.command_post)) {
    probed.address = settings::ipv4_text(own->address);
    const auto claim = applier::probe(options_.command_post, own->address);
    if (!claim) {
      probed.trouble = claim.error();
    } else if (*claim) {
      probed.claimant = (*claim)->mac;
      probed.own = (*claim)->own;
    }
  }
  const auto written =
      host::write_file(options_.status + '/' + network::kProbedFile, network::write(probed), kForAll);
  if (!written) host::log(Level::Error, "an answer cannot be given", {{"why", written.error()}});
}

/// The status, where it is another than was told last.
bool Applier::tell() {
  const network::Status& status = change_->status();
  std::string text = network::write(status);
  if (text == told_) return true;
  const auto written = host::write_file(options_.status + '/' + network::kStatusFile, text, kForAll);
  if (!written) {
    host::log(Level::Error, "the status cannot be told", {{"why", written.error()}});
    return false;
  }
  told_ = std::move(text);
  if (status.pending) {
    host::log(Level::Notice, "a change waits to be confirmed");
  } else if (status.ended != network::Ended::NotYet) {
    host::log(Level::Notice, "a change has ended",
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
