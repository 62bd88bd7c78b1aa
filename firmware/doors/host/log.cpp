#include "host/log.hpp"

// Omits this file's path, so that programs built in different directories are the same.
#define SD_JOURNAL_SUPPRESS_LOCATION

#include <sys/uio.h>
#include <systemd/sd-journal.h>
#include <unistd.h>

#include <cstdlib>
#include <mutex>
#include <utility>

#include "host/log_line.hpp"
#include "loop/loop.hpp"

namespace adit::host {
namespace {

constexpr Level kLeast = Level::Info;

Memory& memory() {
  static Memory records;
  return records;
}

/// Thread-safe.
class LogRedaction {
 public:
  void set(icd::Redaction redaction) {
    const std::scoped_lock lock(mutex_);
    redaction_ = std::move(redaction);
  }
  void strike_from(std::string& text) {
    const std::scoped_lock lock(mutex_);
    redaction_.strike_from(text);
  }

 private:
  std::mutex mutex_;
  icd::Redaction redaction_;
};

LogRedaction& log_redaction() {
  static LogRedaction secrets;
  return secrets;
}

bool to_journal(const std::vector<std::string>& entry) {
  std::vector<iovec> pieces;
  pieces.reserve(entry.size());
  for (const std::string& field : entry) pieces.push_back({const_cast<char*>(field.data()), field.size()});
  return sd_journal_sendv(pieces.data(), static_cast<int>(pieces.size())) == 0;
}

/// One write, so that lines of several threads do not mix. A failing stderr cannot be reported.
void to_stderr(std::string line) {
  line += '\n';
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, line.data(), line.size());
}

void write_down(double at, Level level, std::string_view message, std::span<const Field> fields) {
  static const bool under_journald = is_journal(STDERR_FILENO, std::getenv("JOURNAL_STREAM"));
  if (under_journald && to_journal(journal_entry(level, message, fields))) return;
  to_stderr(plain_line(time_text(at), level, message, fields));
}

}  // namespace

void log(Level level, std::string_view message, std::initializer_list<Field> fields) {
  if (level > kLeast) return;
  const double at = loop::system_now();
  const std::string said = strip_secrets(std::string(message));
  std::vector<Field> struck(fields);
  for (auto& [name, value] : struck) value = strip_secrets(std::move(value));
  memory().keep(at, level, said, struck);
  write_down(at, level, said, struck);
}

void keep_out_of_log(icd::Redaction redaction) {
  log_redaction().set(std::move(redaction));
}

std::string strip_secrets(std::string text) {
  log_redaction().strike_from(text);
  return text;
}

void log_to_console(Level level, std::string_view message, std::initializer_list<Field> fields) {
  if (level > kLeast) return;
  const double at = loop::system_now();
  memory().keep(at, level, message, {});
  write_down(at, level, message, fields);
}

std::vector<Record> records_after(std::uint64_t after) {
  return memory().records_after(after);
}

std::uint64_t last_record_number() {
  return memory().last();
}

std::string line_of(const Record& record) {
  const std::vector<Field> fields(record.fields.begin(), record.fields.end());
  return plain_line(time_text(record.at), record.level, record.message, fields);
}

}  // namespace adit::host
