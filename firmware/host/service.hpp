#pragma once

#include <expected>
#include <optional>
#include <string>

#include "icd/bearer_token.hpp"

namespace adit::host {

/// sd_notify(3): tells systemd that the service is ready, stopping, or how it is ("STATUS="). Nothing outside
/// systemd.
void notify_ready(const std::string& status);
void notify_status(const std::string& status);
void notify_stopping();

/// A small text file, at most 1 MiB.
std::expected<std::string, std::string> read_file(const std::string& path);

/// Writes `text` so that after a crash there is the old file or the new one: a temporary beside it, fsync,
/// rename, fsync of the folder.
std::expected<void, std::string> write_file(const std::string& path, const std::string& text, int mode);

struct Secrets {
  std::optional<icd::BearerToken> scoring, mapping;  // what the Command Post knows the team by
  std::optional<icd::BearerToken> team;  // what the team's clients show; absent: only the other two are good
  std::optional<icd::BearerToken> label_code;  // what sets the first password; absent: one is drawn
};

/// `scoring.token`, `mapping.token`, `team.token` and `label.code` in `folder` (a folder of systemd
/// credentials, or one of mode 0700 with files of mode 0600); white space around a token is cut. An error
/// names the file, never what is in it. A missing or empty scoring or mapping token is an error, a missing or
/// empty team token or code is none. A file that others may read is an error.
std::expected<Secrets, std::string> read_secrets(const std::string& folder);

/// Whether `interface` has a carrier: nothing where there is no such interface; "" is always true.
std::optional<bool> carrier(const std::string& interface);

}  // namespace adit::host
