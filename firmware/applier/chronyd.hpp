#pragma once

#include <string>

#include "clock/chrony.hpp"

namespace adit::applier {

/// chronyd, as systemd runs it (adit-ntp.service) by files that are written here.
class Chronyd {
 public:
  /// `folder`: of these files, nobody else's. `interface`: the team's.
  Chronyd(std::string folder, std::string interface, std::string systemctl)
      : folder_(std::move(folder)), interface_(std::move(interface)), systemctl_(std::move(systemctl)) {}

  /// It is to run, restarted where it is to do something else, or not to run. Gives why that cannot be; or
  /// "".
  std::string run_with(const clock::Ntp& ntp, clock::Source source) const;

 private:
  std::string start(const clock::Chrony& chrony) const;
  std::string stop() const;
  std::string path(const char* name) const { return folder_ + '/' + name; }

  std::string folder_, interface_, systemctl_;
};

}  // namespace adit::applier
