#include "host/log_line.hpp"

#include <sys/stat.h>

#include <ctime>

namespace adit::host {
namespace {

std::string quoted_where_needed(std::string_view value) {
  if (value.find_first_of(" \"=") == std::string_view::npos) return escaped(value);
  std::string text = "\"";
  for (const char c : escaped(value)) {
    if (c == '"') text += '\\';
    text += c;
  }
  return text + '"';
}

/// Journal field names have upper case letters, digits and underscores.
std::string journal_name(std::string_view name) {
  std::string text = "ADIT_";
  for (const char c : name) {
    const bool lower = c >= 'a' && c <= 'z';
    const bool as_is = (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    text += lower ? static_cast<char>(c - 'a' + 'A') : as_is ? c : '_';
  }
  return text;
}

}  // namespace

std::string_view name_of(Level level) {
  static constexpr std::string_view kNames[] = {"error", "warning", "notice", "info", "debug"};
  return kNames[static_cast<std::size_t>(level) - static_cast<std::size_t>(Level::Error)];
}

std::string time_text(double at) {
  const auto seconds = static_cast<std::time_t>(at);
  std::tm parts{};
  if (gmtime_r(&seconds, &parts) == nullptr) return "no date";
  char text[32];
  return {text, std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts)};
}

std::string sentence(std::string_view message, std::span<const Field> fields) {
  std::string text = escaped(message);
  for (const auto& [name, value] : fields) {
    if (value.empty()) continue;
    text.append(" ").append(name).append("=").append(quoted_where_needed(value));
  }
  return text;
}

std::string plain_line(std::string_view time, Level level, std::string_view message,
                       std::span<const Field> fields) {
  return std::string(time).append(" ").append(name_of(level)).append(": ").append(sentence(message, fields));
}

std::vector<std::string> journal_entry(Level level, std::string_view message, std::span<const Field> fields) {
  std::vector<std::string> entry = {"MESSAGE=" + sentence(message, fields),
                                    "PRIORITY=" + std::to_string(static_cast<int>(level)),
                                    "SYSLOG_IDENTIFIER=aditd"};
  for (const auto& [name, value] : fields) {
    if (!value.empty()) entry.push_back(journal_name(name) + "=" + value);
  }
  return entry;
}

bool is_journal(int fd, const char* journal_stream) {
  struct stat file{};
  if (journal_stream == nullptr || fstat(fd, &file) != 0) return false;
  return std::to_string(file.st_dev) + ":" + std::to_string(file.st_ino) == journal_stream;
}

}  // namespace adit::host
