#pragma once

#include <optional>
#include <string>

#include "access/accounts.hpp"
#include "gateway/session_keeper.hpp"
#include "icd/bearer_token.hpp"
#include "loop/workers.hpp"
#include "page/keys.hpp"

namespace adit::gateway {

/// The passwords, kept in the state folder: access.json holds their hashes, and until there is one
/// first-start.code the code that sets it, where the box's label has none. What is wrong with the folder is
/// logged, and keeps nothing else from working.
class Accounts final : public page::Keys {
 public:
  /// Logs the code of a first start, unless it is on the label. `workers` and `sessions` outlive this.
  Accounts(loop::Workers& workers, SessionKeeper& sessions, std::string folder,
           std::optional<icd::BearerToken> label_code);

  bool first_start() const override { return !accounts_.operator_; }
  bool is_code(std::string_view presented) const override;
  void check(std::string password, std::string address,
             std::function<void(std::optional<access::Role>)> done) override;
  void set(access::Role role, std::optional<std::string> password,
           std::function<void(icd::Checked<void>)> done) override;
  access::Sessions& sessions() override { return sessions_.sessions(); }
  access::Secret draw() override;

  /// No passwords any more, a new code, and nobody logged in. False: a password is being set.
  bool forget();

 private:
  std::string file() const { return folder_ + "/access.json"; }
  std::string code_file() const { return folder_ + "/first-start.code"; }
  icd::BearerToken kept_code();

  loop::Workers& workers_;
  SessionKeeper& sessions_;
  std::string folder_;
  access::Accounts accounts_;
  std::optional<icd::BearerToken> code_;
  bool setting_ = false;
};

}  // namespace adit::gateway
