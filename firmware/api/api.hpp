#pragma once

#include <memory>
#include <vector>

#include "icd/bearer_token.hpp"
#include "intake/server.hpp"
#include "loop/loop.hpp"

namespace adit::api {

class Box;
class Keys;
class Network;
class Operator;
class SelfTest;
class Setup;
class Source;
class Updates;

/// The local web page, on the team's side, and the operator's word on reports, behind a login: README.md has
/// its routes, firmware/access/README.md says what protects them.
///
/// Every answer but the events carries a Content-Security-Policy of `default-src 'none'` with what the page
/// needs, X-Content-Type-Options and Referrer-Policy; every error is a JSON string.
class Api final : public intake::Handler {
 public:
  /// `tokens`: any of them lets a script in as an operator; empty: none does. All others outlive this, and
  /// whatever `keys` still answers.
  Api(loop::Loop& loop, const Source& source, Operator& judge, Keys& keys,
      std::vector<icd::BearerToken> tokens);
  ~Api() override;

  /// Serves the settings, too; `setup` outlives this. Once, before anything is opened.
  void serve(Setup& setup);

  std::unique_ptr<intake::BodySink> open(const intake::RequestHead& head,
                                         std::shared_ptr<intake::Responder> responder,
                                         std::shared_ptr<intake::Flow> flow) override;

  /// Serves the box's own addresses and the Test, too; they outlive this. Once, before anything is opened.
  void serve(Network& network, SelfTest& test);

  /// Serves the update of the box, too; it outlives this. Once, before anything is opened.
  void serve(Updates& updates);

  /// Serves what is known of the box, too; it outlives this. Once, before anything is opened.
  void serve(Box& box);

  /// These tokens let a script in from now on.
  void let_in(std::vector<icd::BearerToken> tokens);

  /// Something that the page shows has changed.
  void changed();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace adit::api
