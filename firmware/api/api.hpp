#pragma once

#include <memory>
#include <vector>

#include "icd/bearer_token.hpp"
#include "icd/redaction.hpp"
#include "intake/server.hpp"
#include "loop/loop.hpp"

namespace adit::api {

class Box;
class Clock;
class FinerMap;
class KeptRuns;
class Keys;
class Network;
class Operator;
class SelfTest;
class Setup;
class Source;
class Spare;
class Updates;

/// What the API asks. A route whose member is null is not served.
struct Served {
  const Source& source;
  Operator& judge;
  Keys& keys;
  Setup* setup = nullptr;
  Network* network = nullptr;
  SelfTest* test = nullptr;  // null only where `network` is
  Updates* updates = nullptr;
  Box* box = nullptr;
  KeptRuns* runs = nullptr;
  Clock* clock = nullptr;
  FinerMap* finer = nullptr;  // null: there is no finer level
  Spare* spare = nullptr;
};

/// The API of the page and of scripts, on the team's side and behind a login, and the page's own files.
/// routes.cpp is its table, README.md has it in words, firmware/access/README.md says what protects it.
///
/// Every answer but the events carries X-Content-Type-Options, Referrer-Policy and a Content-Security-Policy
/// of `default-src 'none'` with what the page needs; every error is a JSON string.
class Api final : public intake::Handler {
 public:
  /// `tokens`: any of them lets a script in as an operator; empty: none does. `redaction` is applied to every
  /// answer. The other arguments outlive this, and all work and answers that are under way.
  Api(loop::Loop& loop, const Served& served, std::vector<icd::BearerToken> tokens,
      icd::Redaction redaction = icd::Redaction());
  ~Api() override;

  intake::Shown shown(const intake::RequestHead& head) override;
  std::unique_ptr<intake::BodySink> open(const intake::RequestHead& head,
                                         std::shared_ptr<intake::Responder> responder,
                                         std::shared_ptr<intake::Flow> flow) override;

  /// From now on.
  void let_in(std::vector<icd::BearerToken> tokens, icd::Redaction redaction);

  /// Something that the page shows has changed.
  void changed();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace adit::api
