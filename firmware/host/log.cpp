#include "host/log.hpp"

#include <sys/uio.h>
#include <systemd/sd-journal.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <ctime>

#include "host/record.hpp"

namespace adit::host {
namespace {

std::atomic<Level> least = Level::Info;

/// Wall time: what a person compares with other logs. Policy never reads it (loop::Loop::now does that).
std::string time_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  char text[32];
  return {text, std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts)};
}

bool to_journal(const std::vector<std::string>& entry) {
  std::vector<iovec> pieces;
  pieces.reserve(entry.size());
  for (const std::string& field : entry) pieces.push_back({const_cast<char*>(field.data()), field.size()});
  return sd_journal_sendv(pieces.data(), static_cast<int>(pieces.size())) == 0;
}

/// One write, so that lines of several threads do not mix. There is nowhere to tell of a stderr that fails.
void to_stderr(std::string line) {
  line += '\n';
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, line.data(), line.size());
}

}  // namespace

void log(Level level, std::string_view message, std::initializer_list<Field> fields) {
  if (level > least.load(std::memory_order_relaxed)) return;
  static const bool under_journald = is_journal(STDERR_FILENO, std::getenv("JOURNAL_STREAM"));
  if (under_journald && to_journal(journal_entry(level, message, fields))) return;
  to_stderr(plain_line(time_now(), level, message, fields));
}

void set_least(Level level) {
  least.store(level, std::memory_order_relaxed);
}

}  // namespace adit::host
