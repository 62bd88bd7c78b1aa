#pragma once

#include <cstdint>
#include <deque>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/log.hpp"

namespace adit::host {

/// The last log records, for users without access to the journal: at most kMost records and kMostBytes of
/// text. The oldest are dropped first. Thread-safe.
class Memory {
 public:
  static constexpr std::size_t kMost = 2000;
  static constexpr std::size_t kMostBytes = 1u << 20;
  static constexpr std::size_t kLongest = 4096;  // bytes of a message or a value; the rest is cut

  /// `at`: seconds since 1970.
  void keep(double at, Level level, std::string_view message, std::span<const Field> fields);
  /// Records with a larger number, oldest first.
  std::vector<Record> records_after(std::uint64_t seq) const;
  /// Number of the last stored record; 0: no record yet.
  std::uint64_t last() const;

 private:
  void drop_oldest();

  mutable std::mutex mutex_;
  std::deque<Record> records_;  // by number, without gaps
  std::size_t bytes_ = 0;
  std::uint64_t last_ = 0;
};

/// `message key=value ...`. A value with a space, a quote or "=" is quoted; an empty value is left out.
std::string sentence(std::string_view message, std::span<const Field> fields);

/// "2026-01-31T12:00:00Z". `at`: seconds since 1970.
std::string time_text(double at);

/// `2026-01-31T12:00:00Z warning: message key=value`, without a newline.
std::string plain_line(std::string_view time, Level level, std::string_view message,
                       std::span<const Field> fields);

/// The fields of a journal entry as "NAME=value" (systemd.journal-fields(7)), without empty ones.
std::vector<std::string> journal_entry(Level level, std::string_view message, std::span<const Field> fields);

/// Whether `fd` is the stream in $JOURNAL_STREAM, "<device>:<inode>" (systemd.exec(5)).
bool is_journal(int fd, const char* journal_stream);

}  // namespace adit::host
