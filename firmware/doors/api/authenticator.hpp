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

/// Admission to all routes under /adit/: firmware/rules/access/README.md.
class Authenticator {
 public:
  /// `tokens`: each admits a script. `loop` and `keys` must outlive this object.
  Authenticator(loop::Loop& loop, Keys& keys, std::vector<icd::BearerToken> tokens)
      : loop_(loop), keys_(keys), tokens_(std::move(tokens)) {}

  void set_tokens(std::vector<icd::BearerToken> tokens) { tokens_ = std::move(tokens); }

  /// Error 401 or 403: the client may not do what `who` may.
  icd::Checked<Asker> admit(const intake::RequestHead& head, RouteAccess who);
  /// Visitor::session is valid until the next call on this object.
  std::optional<access::Visitor> find_visitor(const intake::RequestHead& head);
  intake::Credentials read_credentials(const intake::RequestHead& head);
  /// The client's known device, or null. As Devices::find().
  const access::Device* device(const intake::RequestHead& head);
  /// Whether the client may still receive a long answer. This object must outlive the result.
  std::function<bool()> access_check(const Asker& asker);

 private:
  loop::Loop& loop_;
  Keys& keys_;
  std::vector<icd::BearerToken> tokens_;
};

intake::Answer rejection_answer(const icd::Refusal& refusal);

}  // namespace adit::api
