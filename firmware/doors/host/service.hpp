#pragma once

#include <expected>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "icd/bearer_token.hpp"

namespace adit::host {

/// False only if the file or directory is known to be absent. An error gives true.
bool can_exist(const std::string& path);

inline constexpr const char* kDamaged = ".damaged";
/// Renames an unreadable file or directory to PATH + kDamaged, over an earlier one, for examination by a
/// person. Logs `what`, `why` and the path, and a failure to rename.
void set_damaged_aside(const std::string& path, std::string_view what, const std::string& why);

/// "a saved file is damaged; its copy is used"
void log_use_of_copy(const std::string& path);

/// Reads a small text file, at most 1 MiB, without the line of write_kept(). If the checksum is wrong, that
/// line stays, so the parser finds the text damaged.
std::expected<std::string, std::string> read_file(const std::string& path);

/// Modes of files: readable by all, or by this user alone.
inline constexpr int kForAll = 0644, kOursAlone = 0600;

/// Writes `text` so that a crash leaves the old file or the new one: temporary file (PATH.writing), fsync,
/// rename, fsync of the directory. One call at a time for each path.
std::expected<void, std::string> write_file(const std::string& path, const std::string& text, int mode);
/// The same for this user alone, with a checksum in the last line ("crc32 1a2b3c4d"), in two copies: first
/// PATH + kCopy, then PATH.
std::expected<void, std::string> write_kept(const std::string& path, const std::string& text);
inline constexpr const char* kCopy = ".copy";
/// Makes the copy of a file that another program wrote, or an earlier version, if there is none or the file
/// has a right checksum. A failure is logged.
void keep_copy(const std::string& path);
/// The result of parse(text): of the file, or if that is an error, of its copy, which is logged. The outer
/// error: the file, or the copy of a damaged one, cannot be read.
template <class Parse>
auto parse_kept(const std::string& path, Parse parse)
    -> std::expected<decltype(parse(std::string_view())), std::string> {
  const auto text = read_file(path);
  if (!text) return std::unexpected(text.error());
  auto parsed = parse(std::string_view(*text));
  if (parsed) return parsed;
  if (!can_exist(path + kCopy)) return parsed;
  const auto copy = read_file(path + kCopy);
  if (!copy) return std::unexpected(copy.error());
  auto copied = parse(std::string_view(*copy));
  if (!copied) return parsed;
  log_use_of_copy(path);
  return copied;
}
/// Overwrites an existing file, which needs no free space. After a crash, each 512-byte sector is old or new.
std::expected<void, std::string> overwrite(const std::string& path, const std::string& text);
/// Removes temporary files that a crash during write_file() left. Call before the first write there.
void remove_unwritten(const std::string& folder);

/// Calls `each` with each entry's name, unordered, until it returns false. Errno: not read completely.
std::expected<void, int> for_each_name(const std::string& folder,
                                       const std::function<bool(std::string_view)>& each);

/// The sorted names in a directory; empty if it does not exist. Error, without the directory's name: it
/// cannot be read completely, or holds more than `most`.
inline constexpr std::size_t kMostNames = 256;
std::expected<std::vector<std::string>, std::string> names_in(const std::string& folder,
                                                              std::size_t most = kMostNames);

/// Removes a file and its copy, and syncs the removal. An absent file is no error. An error names the file.
std::expected<void, std::string> remove_file(const std::string& path);

struct Secrets {
  std::map<std::string, icd::BearerToken, std::less<>> tokens;  // by name: "scoring", "course.A.mapping"
  std::optional<icd::BearerToken> label_code =
      std::nullopt;                                 // code for the first password; absent: one is drawn
  std::map<std::string, std::string> damaged = {};  // by name: why a saved token is invalid; the given one is
                                                    // then not used
  std::vector<icd::BearerToken> replaced = {};      // earlier tokens, which logs and exports may still quote
  std::string unread = "";  // why a file cannot be read, so that a token is missing; or ""

  icd::Redaction redaction() const;
  /// Sentences by name: damaged tokens, and Command Post tokens with a length other than the ICD's (4).
  std::map<std::string, std::string> token_warnings() const;
  std::optional<icd::BearerToken> token(std::string_view name) const {
    const auto found = tokens.find(name);
    return found == tokens.end() ? std::nullopt : std::optional(found->second);
  }
};

/// Below the saved tokens: earlier tokens, each in a line.
inline constexpr const char* kReplacedFile = "replaced";

/// Ending of an empty file that marks a file as saved. While it is there, a saved file that is gone is lost,
/// and no given one takes its place.
inline constexpr const char* kSavedMark = ".saved";

/// The mark of NAME.token in `saved`. It is beside `saved`, so that it remains if that directory is lost.
std::string token_mark(const std::string& saved, std::string_view name);

/// Reads the tokens of these names, each from NAME.token in `saved` or else in `given`, and `label.code` in
/// `given`. A lost token (kSavedMark) is damaged. `given` holds systemd credentials, or has mode 0700 and
/// files of mode 0600. White space around a token is removed. A missing file, or an empty one in `given`, is
/// no token. An error names the file in `given`, never its content: other users may read it, or it holds no
/// token.
std::expected<Secrets, std::string> read_secrets(const std::string& given, const std::string& saved,
                                                 std::span<const std::string> names);

/// Identifies this boot; "" if unknown.
std::string boot();

/// Whether `interface` has a carrier. std::nullopt: no such interface. True for "".
std::optional<bool> carrier(const std::string& interface);

}  // namespace adit::host
