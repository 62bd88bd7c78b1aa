#pragma once

#include <optional>
#include <string>
#include <vector>

#include "icd/bearer_token.hpp"
#include "icd/status.hpp"
#include "settings/settings.hpp"

namespace adit::api {

/// A token's name ("scoring", "course.A.mapping"), presence, and a warning about it; never the token itself.
struct TokenRow {
  std::string name;
  bool set = false;
  std::string warning = {};
};

/// The settings and tokens in use, and their changes. An answered change is on disk and about to be applied;
/// after a reset the gateway restarts. Error: 409 while another change is being applied, 503 if it cannot be
/// written.
class Setup {
 public:
  virtual ~Setup() = default;

  /// As written: the Command Post's own endpoints, even if a course is in use.
  virtual const settings::Settings& settings() const = 0;
  /// Whether they were saved here; otherwise they were given.
  virtual bool is_saved() const = 0;
  /// Whether a change is about to be applied. The other functions return the earlier values until then.
  virtual bool applying() const = 0;
  /// Why the last change is not in use (reverted, incomplete), as a sentence; or "".
  virtual const std::string& trouble() const = 0;
  /// All possible tokens with these courses.
  virtual std::vector<TokenRow> tokens() const = 0;
  /// Warnings for the operator before `next` is applied.
  virtual std::vector<std::string> warnings(const settings::Settings& next) const = 0;

  /// Has no effect if these settings are in use and on disk.
  virtual icd::Checked<void> save(const settings::Settings& next) = 0;
  /// `name`: one of tokens(). std::nullopt removes the saved token, so that the given one is used.
  virtual icd::Checked<void> set_token(const std::string& name,
                                       const std::optional<icd::BearerToken>& token) = 0;
  /// Returns to the given settings and tokens, removes passwords and ends all sessions. The ledger stays.
  virtual icd::Checked<void> reset() = 0;
};

}  // namespace adit::api
