#include "host/log_line.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <cstdint>
#include <ctime>

#include "codec/utf8.hpp"
#include "host/log.hpp"
#include "icd/text.hpp"

namespace adit::host {
namespace {

std::string clip(std::string_view text) {
  return std::string(text.substr(0, Memory::kLongest));
}

std::size_t bytes_of(const Record& record) {
  std::size_t bytes = sizeof record + record.message.size();
  for (const auto& [name, value] : record.fields) bytes += 2 * sizeof name + name.size() + value.size();
  return bytes;
}

}  // namespace

void Memory::keep(double at, Level level, std::string_view message, std::span<const Field> fields) {
  Record record{.seq = 0, .at = at, .level = level, .message = clip(message), .fields = {}};
  record.fields.reserve(fields.size());
  for (const auto& [name, value] : fields) {
    if (!value.empty()) record.fields.emplace_back(name, clip(value));
  }
  const std::scoped_lock lock(mutex_);
  record.seq = ++last_;
  bytes_ += bytes_of(record);
  records_.push_back(std::move(record));
  while (records_.size() > kMost || bytes_ > kMostBytes) drop_oldest();
}

void Memory::drop_oldest() {
  bytes_ -= bytes_of(records_.front());
  records_.pop_front();
}

std::uint64_t Memory::last() const {
  const std::scoped_lock lock(mutex_);
  return last_;
}

std::vector<Record> Memory::records_after(std::uint64_t seq) const {
  const std::scoped_lock lock(mutex_);
  const auto first = std::ranges::upper_bound(records_, seq, {}, &Record::seq);
  return {first, records_.end()};
}

namespace {

/// Characters that control or deceive a terminal: C1 controls, characters without width or that change the
/// writing direction, Unicode's line ends, tags (Unicode 15, 23.2 to 23.9).
struct Span {
  char32_t first, last;
};
constexpr Span kUnseen[] = {{0x80, 0x9f},     {0xad, 0xad},      {0x61c, 0x61c},   {0x180e, 0x180e},
                            {0x200b, 0x200f}, {0x2028, 0x202e},  {0x2060, 0x206f}, {0xfeff, 0xfeff},
                            {0xfff9, 0xffff}, {0xe0000, 0xeffff}};

/// The code of a UTF-8 character of several bytes.
char32_t to_code_point(std::string_view character) {
  const auto first = static_cast<std::uint8_t>(character[0]);
  char32_t code = first & (0xffu >> (character.size() + 1));
  for (const char c : character.substr(1)) code = code << 6 | (static_cast<std::uint8_t>(c) & 0x3fu);
  return code;
}

/// Length of the first character in bytes. 0: invisible, or not UTF-8.
std::size_t visible(std::string_view text) {
  const auto first = static_cast<std::uint8_t>(text[0]);
  const std::string_view character = text.substr(0, codec::character_size(text));
  if (character.size() <= 1) return first >= 0x20 && first < 0x7f ? 1 : 0;
  const bool unseen = std::ranges::any_of(kUnseen, [code = to_code_point(character)](const Span& span) {
    return code >= span.first && code <= span.last;
  });
  return unseen ? 0 : character.size();
}

}  // namespace

std::string escape(std::string_view text) {
  std::string safe;
  safe.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = visible(text);
    if (text[0] == '\\') {
      safe += "\\\\";
    } else if (length > 0) {
      safe += text.substr(0, length);
    } else {
      safe += "\\x" + icd::hex(static_cast<std::uint8_t>(text[0]));
    }
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return safe;
}

std::string to_ascii(std::string_view text) {
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) {
    if (static_cast<std::uint8_t>(c) < 0x80) {
      safe += c;
    } else {
      safe += "\\x" + icd::hex(static_cast<std::uint8_t>(c));
    }
  }
  return safe;
}

namespace {

std::string quoted_where_needed(std::string_view value) {
  if (value.find_first_of(" \"=") == std::string_view::npos) return escape(value);
  std::string text = "\"";
  for (const char c : escape(value)) {
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
  std::string text = escape(message);
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
