#pragma once

#include <chrono>
#include <expected>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "icd/bearer_token.hpp"
#include "icd/redaction.hpp"

namespace adit::host {

/// sd_notify(3): tells systemd that the service is ready, stopping, or how it is ("STATUS="). Nothing outside
/// systemd.
void notify_ready(const std::string& status);
void notify_status(const std::string& status);
void notify_stopping();
/// The process is about to start again (inherited.hpp). Until notify_ready() systemd gives it as long as any
/// start.
void notify_starting_again();
void notify_alive();                                      // WATCHDOG=1
inline constexpr std::chrono::seconds kLongestStart{60};  // services/adit.service: TimeoutStartSec=

/// How long systemd waits for a sign of life (WatchdogSec=) before it kills the service; nothing where it
/// does not wait for any.
std::optional<std::chrono::microseconds> watchdog_within();

/// Whether there is a file or folder of that name, or nobody can say: what cannot be looked for is not
/// absent.
bool may_exist(const std::string& path);

inline constexpr const char* kDamaged = ".damaged";
/// Renames a file or folder that cannot be read to PATH + kDamaged, over an earlier one, so that a person can
/// look at it. Logs `what`, `why` and the path, and a failure to rename.
void set_damaged_aside(const std::string& path, std::string_view what, const std::string& why);

/// A small text file, at most 1 MiB, without the line of write_kept(). If its checksum is wrong, that line
/// stays: whoever reads the text finds it damaged.
std::expected<std::string, std::string> read_file(const std::string& path);

/// Modes of files: readable for everybody, or for nobody else.
inline constexpr int kForAll = 0644, kOursAlone = 0600;

/// Writes `text` so that after a crash there is the old file or the new one: a temporary beside it
/// (PATH.writing), fsync, rename, fsync of the folder. One call at a time for a path.
std::expected<void, std::string> write_file(const std::string& path, const std::string& text, int mode);
/// The same for this user alone, with a checksum in a last line ("crc32 1a2b3c4d").
std::expected<void, std::string> write_kept(const std::string& path, const std::string& text);
/// Writes over the file that is there, which takes no more room on a full disk: of at most 512 bytes, which a
/// disk writes all or none of.
std::expected<void, std::string> write_over(const std::string& path, const std::string& text);
/// Removes what write_file() leaves in a folder when the process dies before the rename. Before the first
/// write there.
void remove_unwritten(const std::string& folder);

/// Calls `each` with the name of each entry of a folder, in no order, until it gives false. An errno: the
/// folder cannot be read to its end.
std::expected<void, int> for_each_name(const std::string& folder,
                                       const std::function<bool(std::string_view)>& each);

/// The names of what is in a folder, in order; none where there is no such folder. An error, without the
/// folder's name: it cannot be read to its end, or holds more than `most`.
inline constexpr std::size_t kMostNames = 256;
std::expected<std::vector<std::string>, std::string> names_in(const std::string& folder,
                                                              std::size_t most = kMostNames);

/// Removes a file, for good once this has succeeded; also where there was none. An error names the file.
std::expected<void, std::string> remove_file(const std::string& path);

struct Secrets {
  std::map<std::string, icd::BearerToken, std::less<>> tokens;  // by name: "scoring", "course.A.mapping"
  std::optional<icd::BearerToken> label_code =
      std::nullopt;                                 // what sets the first password; absent: one is drawn
  std::map<std::string, std::string> damaged = {};  // by name: why a saved token is none, nor the given one
  std::string unread = "";  // why a file cannot be read, so that a token is missing; or ""

  icd::Redaction redaction() const;
  /// A sentence by the name: of damaged tokens, and of the Command Post's tokens whose length is none that
  /// the ICD (4) gives them.
  std::map<std::string, std::string> odd_tokens() const;
  std::optional<icd::BearerToken> token(std::string_view name) const {
    const auto found = tokens.find(name);
    return found == tokens.end() ? std::nullopt : std::optional(found->second);
  }
};

/// The tokens of these names, each in NAME.token in `saved` or else in `given` (a folder of systemd
/// credentials, or one of mode 0700 with files of mode 0600); and `label.code` in `given`. White space around
/// a token is cut; a missing file is none, as is an empty one in `given`. An error names the file in `given`,
/// never its content: others may read it, or it holds no token.
std::expected<Secrets, std::string> read_secrets(const std::string& given, const std::string& saved,
                                                 std::span<const std::string> names);

/// Names this start of the machine; "" where that cannot be known.
std::string boot();

/// Whether `interface` has a carrier: nothing where there is no such interface; "" is always true.
std::optional<bool> carrier(const std::string& interface);

}  // namespace adit::host
