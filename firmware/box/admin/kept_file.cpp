#include "admin/kept_file.hpp"

#include <utility>

#include "access/sessions.hpp"
#include "host/log.hpp"
#include "host/service.hpp"

namespace adit::admin {

AcknowledgementFile::AcknowledgementFile(const std::string& state_folder, loop::Writer& writer)
    : file_(state_folder + '/' + kFile), writer_(writer) {}

std::vector<alarms::Acknowledgement> AcknowledgementFile::read() {
  auto read = read_kept_file(file_, &alarms::read_acknowledged, unread_);
  if (!read) {
    host::log(host::Level::Warning, "cannot read the acknowledged alarms: no alarm is acknowledged",
              {{"why", read.error()}});
    return {};
  }
  kept_ = *read;
  return *std::move(read);
}

void AcknowledgementFile::keep(std::vector<alarms::Acknowledgement> all) {
  if (all == kept_) return;
  kept_ = std::move(all);
  if (!unread_.empty()) return;
  const auto write = [file = file_, text = alarms::write_acknowledged(kept_), failed = failed_] {
    const auto written = host::write_kept(file, text);
    const bool failed_before = std::exchange(*failed, !written.has_value());
    if (written || failed_before) return;
    host::log(host::Level::Warning, "cannot store the acknowledged alarms: they are only in memory",
              {{"why", written.error()}});
  };
  writer_.submit(write, [] {});
}

SessionKeeper::SessionKeeper(std::string file, access::Instant now)
    : file_(std::move(file)), boot_(host::boot()), sessions_([this] { keep(); }) {
  auto kept = read_kept_file(file_, &access::read_sessions, unread_);
  if (!kept) {
    host::log(host::Level::Warning, "cannot read the sessions: users have to log in again",
              {{"why", kept.error()}});
  } else if (kept->boot == boot_) {
    sessions_.restore(std::move(kept->sessions), kept->last, now);
  }
}

void SessionKeeper::keep() {
  if (!unread_.empty()) return;
  access::KeptSessions kept{.boot = boot_, .last = sessions_.last(), .sessions = sessions_.entries()};
  const auto written = host::write_kept(file_, access::write_sessions(kept));
  const bool failed_before = std::exchange(failed_, !written.has_value());
  if (written || failed_before) return;
  host::log(host::Level::Warning, "cannot store the sessions: they are only in memory",
            {{"why", written.error()}});
}

}  // namespace adit::admin
