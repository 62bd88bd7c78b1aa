#include "box/links.hpp"

#include <sys/epoll.h>

#include <utility>

#include "host/link_changes.hpp"
#include "host/log.hpp"

namespace adit::box {

Links::Links(loop::Loop& loop, const settings::Settings& settings, Look look, loop::FileDescriptor kernel,
             std::function<void()> changed, std::function<void()> back)
    : look_(std::move(look)),
      changed_(std::move(changed)),
      back_(std::move(back)),
      links_{{{.side = "team", .interface = settings.team.interface},
              {.side = "command_post", .interface = settings.command_post.interface}}},
      kernel_(std::move(kernel)) {
  if (kernel_) {
    told_ = loop.watch(kernel_.get(), EPOLLIN, [this](std::uint32_t) {
      if (!host::take_link_changes(kernel_)) told_.wait_for(0);
      this->look();
    });
  }
  for (Link& link : links_) link.carrier = look_(link.interface);
}

void Links::look_at(const settings::Settings& settings) {
  const std::string* const interfaces[] = {&settings.team.interface, &settings.command_post.interface};
  for (std::size_t i = 0; i < links_.size(); ++i) {
    if (links_[i].interface == *interfaces[i]) continue;
    links_[i].interface = *interfaces[i];
    links_[i].carrier = look_(links_[i].interface);
  }
}

void Links::look() {
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

std::vector<api::LinkRow> Links::rows() const {
  std::vector<api::LinkRow> rows;
  for (const Link& link : links_) {
    if (!link.interface.empty())
      rows.push_back({.side = link.side, .interface = link.interface, .carrier = link.carrier});
  }
  return rows;
}

}  // namespace adit::box
