#include "applier/sought.hpp"

#include <sys/epoll.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

#include "applier/takers.hpp"
#include "host/root_program.hpp"

namespace adit::applier {

std::vector<std::uint32_t> sought_in(const network::Status& status, const std::vector<settings::Subnet>& own,
                                     const std::vector<settings::Subnet>& team) {
  const network::Numbers numbers = status.kept.value_or(network::Numbers{.command_post = own});
  std::vector<std::uint32_t> all;
  for (const std::uint32_t endpoint : status.endpoints.addresses) {
    const auto hop = network::next_hop(numbers, endpoint);
    const auto has = [hop](const settings::Subnet& each) { return each.contains(*hop); };
    if (hop && std::ranges::none_of(team, has)) all.push_back(*hop);
  }
  std::ranges::sort(all);
  const auto twice = std::ranges::unique(all);
  all.erase(twice.begin(), twice.end());
  all.resize(std::min(all.size(), Takers::kMost));
  return all;
}

ToldStatus::ToldStatus(loop::Loop& loop, std::string folder, std::function<void()> changed)
    : loop_(loop), folder_(std::move(folder)), changed_(std::move(changed)), due_(loop.timer([this] {
        watch_folder();
        changed_();
      })) {
  watch_folder();
}

void ToldStatus::watch_folder() {
  notices_ = loop::FileDescriptor(inotify_init1(IN_NONBLOCK | IN_CLOEXEC));
  if (!notices_ || inotify_add_watch(notices_.get(), folder_.c_str(), IN_MOVED_TO) < 0)
    return due_.call_at(loop_.now() + kLookAgain);
  noticed_ = loop_.watch(notices_.get(), EPOLLIN, [this](std::uint32_t) {
    char events[4096];
    while (::read(notices_.get(), events, sizeof events) > 0) {
    }
    changed_();
  });
}

network::Status ToldStatus::read() const {
  const host::StatusFile file(folder_ + '/' + host::kStatusFile);
  return file.told<network::Status>().value_or(network::Status{});
}

}  // namespace adit::applier
