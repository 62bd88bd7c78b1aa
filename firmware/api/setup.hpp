#pragma once

#include <optional>
#include <string>
#include <vector>

#include "icd/bearer_token.hpp"
#include "icd/status.hpp"
#include "settings/settings.hpp"

namespace adit::api {

/// A token by its name ("scoring", "course.A.mapping"), and whether there is one; never the token itself.
struct TokenRow {
  std::string name;
  bool set = false;
};

/// The settings and tokens that the box runs with, and what changes them: each change is on the disk and
/// about to be applied once it is answered; after a reset the gateway begins anew. Refused: 409 while another
/// is being applied, 503 where it cannot be written.
class Setup {
 public:
  virtual ~Setup() = default;

  /// As they are written: the Command Post's own endpoints even where a course is in use.
  virtual const settings::Settings& settings() const = 0;
  /// Whether they were saved here, or are those that the box was given.
  virtual bool saved() const = 0;
  /// Whether a change was taken and is about to be applied: all the rest is as it was before that.
  virtual bool applying() const = 0;
  /// Why the last change is not in use (it was taken back, it is half done): a sentence, or "".
  virtual const std::string& trouble() const = 0;
  /// All tokens that there can be, by the courses there are.
  virtual std::vector<TokenRow> tokens() const = 0;
  /// What the operator should know before `next` is applied.
  virtual std::vector<std::string> warnings(const settings::Settings& next) const = 0;

  /// Those that it runs with, and that are on the disk, are nothing to apply.
  virtual icd::Checked<void> save(const settings::Settings& next) = 0;
  /// `name` is one of tokens(). Nothing: the saved one is removed, and the one that the box was given counts.
  virtual icd::Checked<void> set_token(const std::string& name,
                                       const std::optional<icd::BearerToken>& token) = 0;
  /// Back to how the box was given: no saved settings and tokens, no passwords, nobody logged in. The ledger
  /// stays.
  virtual icd::Checked<void> reset() = 0;
};

}  // namespace adit::api
