#pragma once

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "access/admission.hpp"
#include "api/keys.hpp"
#include "api/route.hpp"
#include "icd/bearer_token.hpp"
#include "intake/server.hpp"
#include "loop/loop.hpp"

namespace adit::api {

/// The one door to what is under /adit/: firmware/access/README.md says who comes in.
class Entrance {
 public:
  /// `tokens`: any of them lets a script in; empty: none does. `loop` and `keys` outlive this.
  Entrance(loop::Loop& loop, Keys& keys, std::vector<icd::BearerToken> tokens)
      : loop_(loop), keys_(keys), tokens_(std::move(tokens)) {}

  /// These let a script in from now on.
  void let_in(std::vector<icd::BearerToken> tokens) { tokens_ = std::move(tokens); }

  /// 401 or 403 if the asker may not do what `who` may.
  icd::Checked<Asker> admit(const intake::RequestHead& head, Who who);
  /// Visitor::session is valid until the next call of anything here.
  std::optional<access::Visitor> who(const intake::RequestHead& head);
  intake::Shown shown(const intake::RequestHead& head);
  /// The asking browser, if somebody has logged in from it before, or null. As Devices::find().
  const access::Device* device(const intake::RequestHead& head);
  /// Whether the asker may still be given more of a long answer. This outlives the result.
  std::function<bool()> may_stay(const Asker& asker);

  access::Sessions& sessions() { return keys_.sessions(); }

 private:
  loop::Loop& loop_;
  Keys& keys_;
  std::vector<icd::BearerToken> tokens_;
};

/// The answer for whoever is not let in.
intake::Answer turned_away(const icd::Refusal& refusal);

}  // namespace adit::api
