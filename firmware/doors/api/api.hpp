#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "api/answers.hpp"
#include "api/authenticator.hpp"
#include "api/box_routes.hpp"
#include "api/map_routes.hpp"
#include "api/page_routes.hpp"
#include "api/report_routes.hpp"
#include "api/route.hpp"
#include "api/run_routes.hpp"
#include "api/session_routes.hpp"
#include "icd/bearer_token.hpp"
#include "intake/server.hpp"
#include "loop/loop.hpp"

namespace adit::api {

struct ApiServices {
  Source& source;
  Operator& decisions;
  GatewayControl& gateway_control;
  Keys& keys;
  Setup& setup;
  Network& network;
  SelfTest& test;
  Updates& updates;
  Box& box;
  KeptRuns& runs;
  Clock& clock;
  FineMap& finer;
  CoveredMap& covered;
  Spare& spare;
  Certificate& certificate;
};

/// The API for the page and for scripts, on the team's side after a login, and the page's files. Table:
/// routes.cpp. Description: README.md. Protection: firmware/rules/access/README.md.
///
/// Every answer except events has X-Content-Type-Options, Referrer-Policy and a Content-Security-Policy of
/// `default-src 'none'` with the page's needs. Every error is a JSON string.
class Api final : public intake::Handler {
 public:
  /// `tokens`: each admits a script as an operator. `redaction`: applied to every answer. The other arguments
  /// must outlive this object, and all work and answers in progress.
  Api(loop::Loop& loop, const ApiServices& served, std::vector<icd::BearerToken> tokens,
      icd::Redaction redaction = icd::Redaction());

  intake::Credentials read_credentials(const intake::RequestHead& head) override {
    return authenticator_.read_credentials(head);
  }
  std::unique_ptr<intake::BodySink> open(const intake::RequestHead& head,
                                         std::shared_ptr<intake::Responder> asked_by,
                                         std::shared_ptr<intake::FlowControl> flow) override;

  void set_tokens(std::vector<icd::BearerToken> tokens, icd::Redaction redaction);

  /// Call after a change of data that the page shows.
  void on_changed() { live_.on_changed(); }

 private:
  void handle(const Route& route, const Call& call);
  /// The answer to a browser that has to use HTTPS, or std::nullopt.
  std::optional<intake::Answer> redirect_to_https(const intake::RequestHead& head) const;

  const Setup& setup_;
  const Certificate& certificate_;
  const std::shared_ptr<SharedRedaction> redaction_;
  Authenticator authenticator_;
  RunStream live_;
  PageRoutes pages_;
  SessionRoutes sessions_;
  RunRoutes run_;
  MapRoutes maps_;
  const ReportLists lists_;
  ReportRoutes reports_;
  BoxRoutes box_;
  KeptRunsRoutes kept_;
  const Handlers handlers_;
};

}  // namespace adit::api
