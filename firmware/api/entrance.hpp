#pragma once

#include <functional>
#include <vector>

#include "access/admission.hpp"
#include "icd/bearer_token.hpp"
#include "intake/server.hpp"
#include "loop/loop.hpp"

namespace adit::api {

/// The one door to what is under /adit/: firmware/access/README.md says who comes in.
class Entrance {
 public:
  /// `tokens`: any of them lets a script in; empty: none does. `loop` and `sessions` outlive this.
  Entrance(loop::Loop& loop, access::Sessions& sessions, std::vector<icd::BearerToken> tokens)
      : loop_(loop), sessions_(sessions), tokens_(std::move(tokens)) {}

  /// These let a script in from now on.
  void let_in(std::vector<icd::BearerToken> tokens) { tokens_ = std::move(tokens); }

  /// Visitor::session is valid until the next call of anything here.
  icd::Checked<access::Visitor> admit(const intake::RequestHead& head, access::Role role);
  std::optional<access::Visitor> who(const intake::RequestHead& head);
  /// Whether the visitor may still be given more of a long answer. This outlives the result.
  std::function<bool()> may_stay(const access::Visitor& visitor);

  access::Sessions& sessions() { return sessions_; }

 private:
  loop::Loop& loop_;
  access::Sessions& sessions_;
  std::vector<icd::BearerToken> tokens_;
};

access::Request request_of(const intake::RequestHead& head);

/// The answer for whoever may not come in.
intake::Answer turned_away(const icd::Refusal& refusal);

}  // namespace adit::api
