#pragma once

#include <optional>
#include <string>
#include <vector>

#include "icd/bearer_token.hpp"
#include "icd/status.hpp"
#include "settings/settings.hpp"

namespace adit::api {

/// A token's name ("scoring", "course.A.mapping"), its presence, and a warning about it; never the token
/// itself.
struct TokenRow {
  std::string name;
  bool set = false;
  std::string warning = {};
};

/// The settings and tokens that the box runs with, and what changes them. A change that is answered is on the
/// disk and about to be applied; after a reset the gateway restarts. Refused: 409 while another change is
/// being applied, 503 if it cannot be written.
class Setup {
 public:
  virtual ~Setup() = default;

  /// As they are written: the Command Post's own endpoints, even if a course is in use.
  virtual const settings::Settings& settings() const = 0;
  /// Whether they were saved here; else they are those that the box was given.
  virtual bool saved() const = 0;
  /// Whether a change was taken and is about to be applied; the other functions still give what was before.
  virtual bool applying() const = 0;
  /// Why the last change is not in use (it was reverted, it is half done): a sentence, or "".
  virtual const std::string& trouble() const = 0;
  /// All tokens that there can be with these courses.
  virtual std::vector<TokenRow> tokens() const = 0;
  /// What the operator should know before `next` is applied.
  virtual std::vector<std::string> warnings(const settings::Settings& next) const = 0;

  /// Nothing is applied if the box runs with these already, and they are on the disk.
  virtual icd::Checked<void> save(const settings::Settings& next) = 0;
  /// `name` is one of tokens(). Nothing: the saved one is removed, and the one that the box was given is
  /// used.
  virtual icd::Checked<void> set_token(const std::string& name,
                                       const std::optional<icd::BearerToken>& token) = 0;
  /// Back to how the box was given: no saved settings and tokens, no passwords, nobody logged in. The ledger
  /// stays.
  virtual icd::Checked<void> reset() = 0;
};

}  // namespace adit::api
