#pragma once

#include <string>

#include "clock/chrony.hpp"

namespace adit::applier {

/// chronyd, run by systemd (adit-ntp.service) from files written here.
class Chronyd {
 public:
  /// `folder`: for these files alone. `interface`: the team's.
  Chronyd(std::string folder, std::string interface, std::string systemctl)
      : folder_(std::move(folder)), interface_(std::move(interface)), systemctl_(std::move(systemctl)) {}

  /// Starts, restarts or stops chronyd as needed. Returns why that failed, or "".
  std::string run_with(const clock::Ntp& ntp, clock::Source source) const;

 private:
  std::string start(const clock::Chrony& chrony) const;
  std::string stop() const;
  std::string path(const char* name) const { return folder_ + '/' + name; }

  std::string folder_, interface_, systemctl_;
};

}  // namespace adit::applier
