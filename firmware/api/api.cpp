#include "api/api.hpp"

#include <optional>
#include <utility>

#include "api/answers.hpp"
#include "api/box_routes.hpp"
#include "api/clock_routes.hpp"
#include "api/entrance.hpp"
#include "api/kept_runs_routes.hpp"
#include "api/live.hpp"
#include "api/map_routes.hpp"
#include "api/network_routes.hpp"
#include "api/packed.hpp"
#include "api/page_routes.hpp"
#include "api/redacted.hpp"
#include "api/report_routes.hpp"
#include "api/routes.hpp"
#include "api/run_routes.hpp"
#include "api/session_routes.hpp"
#include "api/settings_routes.hpp"
#include "api/small_body.hpp"
#include "api/spare_routes.hpp"
#include "api/update_routes.hpp"
#include "codec/body_decoder.hpp"
#include "icd/sentence.hpp"

namespace adit::api {
namespace {

constexpr std::string_view kGuarded = "/adit/";  // what is not in the table of routes: a page's file, or this

/// Why a body is refused by its head.
std::optional<intake::Answer> unfit(const Body& body, const intake::RequestHead& head) {
  if (body.type.empty()) return std::nullopt;
  const std::string_view type = head.header("Content-Type");
  const bool fits = body.as_it_comes ? type == body.type : codec::format_of(type) == codec::Format::Json;
  if (!fits) {
    return refusal(icd::Status::UnprocessableEntity, icd::sentence("Content-Type: expected ", body.type));
  }
  if (head.content_length().value_or(0) <= body.most) return std::nullopt;
  return SmallBody::too_long(body.most, body.as_it_comes ? "file" : "body");
}

}  // namespace

class Api::Impl {
 public:
  Impl(loop::Loop& loop, const Served& served, std::vector<icd::BearerToken> tokens, icd::Redaction redaction)
      : redaction_(std::make_shared<SharedRedaction>(shared(std::move(redaction)))),
        entrance_(loop, served.keys, std::move(tokens)),
        live_(loop, served.source),
        sessions_(loop, entrance_, served.keys, served.setup),
        run_(served.source, served.judge, live_, entrance_),
        maps_(served.source, served.finer),
        lists_(loop, served.source),
        reports_(lists_, served.source, served.judge, [this] { changed(); }) {
    if (served.setup) settings_.emplace(*served.setup);
    if (served.network) network_.emplace(*served.network, *served.test, [this] { changed(); });
    if (served.updates) updates_.emplace(*served.updates, [this] { changed(); });
    if (served.box) box_.emplace(served.source, lists_, *served.box, entrance_, *redaction_, loop);
    if (served.clock) clock_.emplace(*served.clock, [this] { changed(); });
    if (served.spare) spare_.emplace(*served.spare, [this] { changed(); });
    if (served.runs) kept_.emplace(loop, *served.runs, served.source);
    handlers_ = {&pages_,      &sessions_,   &run_,    &maps_,    &reports_,  at(settings_),
                 at(network_), at(updates_), at(box_), at(kept_), at(clock_), at(spare_)};
  }

  std::unique_ptr<intake::BodySink> open(const intake::RequestHead& head,
                                         std::shared_ptr<intake::Responder> asked_by,
                                         std::shared_ptr<intake::Flow> flow) {
    auto responder = redacted(packing(std::move(asked_by), head), redaction_);
    Match found = match(handlers_, head);
    const auto refuse = [&responder](intake::Answer answer) {
      responder->answer(std::move(answer));
      return nullptr;
    };
    if (found.allowed.empty() && !found.route && !head.path().starts_with(kGuarded)) {
      return refuse(pages_.file(head));
    }
    const auto asker = entrance_.admit(head, found.who);
    if (!asker) return refuse(turned_away(asker.error()));
    if (!found.route)
      return refuse(found.allowed.empty() ? nothing_at(head.path()) : wrong_method(found.allowed));
    const Route& route = *found.route;
    if (auto why = unfit(route.body, head)) return refuse(std::move(*why));
    Call call{.head = head,
              .responder = std::move(responder),
              .flow = std::move(flow),
              .asker = *asker,
              .parameters = std::move(found.parameters),
              .body = {}};
    if (route.body.type.empty() || route.body.as_it_comes) return handle(route, call);
    return std::make_unique<SmallBody>(call.responder, route.body.most,
                                       [this, &route, call](std::string body) mutable {
                                         call.body = std::move(body);
                                         handle(route, call);
                                       });
  }

  intake::Shown shown(const intake::RequestHead& head) { return entrance_.shown(head); }
  void changed() { live_.changed(); }
  void let_in(std::vector<icd::BearerToken> tokens, icd::Redaction redaction) {
    entrance_.let_in(std::move(tokens));
    *redaction_ = shared(std::move(redaction));
  }

 private:
  static SharedRedaction shared(icd::Redaction redaction) {
    return std::make_shared<icd::Redaction>(std::move(redaction));
  }

  std::unique_ptr<intake::BodySink> handle(const Route& route, const Call& call) const {
    if (route.handle.answer == nullptr) return route.handle.begin(handlers_, call);
    call.responder->answer(route.handle.answer(handlers_, call));
    return nullptr;
  }

  template <class Routes>
  static Routes* at(std::optional<Routes>& routes) {
    return routes ? &*routes : nullptr;
  }

  const std::shared_ptr<SharedRedaction> redaction_;
  Entrance entrance_;
  Live live_;
  PageRoutes pages_;
  SessionRoutes sessions_;
  RunRoutes run_;
  MapRoutes maps_;
  const ReportLists lists_;
  ReportRoutes reports_;
  std::optional<SettingsRoutes> settings_;
  std::optional<NetworkRoutes> network_;
  std::optional<UpdateRoutes> updates_;
  std::optional<BoxRoutes> box_;
  std::optional<KeptRunsRoutes> kept_;
  std::optional<ClockRoutes> clock_;
  std::optional<SpareRoutes> spare_;
  Handlers handlers_;
};

Api::Api(loop::Loop& loop, const Served& served, std::vector<icd::BearerToken> tokens,
         icd::Redaction redaction)
    : impl_(std::make_unique<Impl>(loop, served, std::move(tokens), std::move(redaction))) {}
Api::~Api() = default;

intake::Shown Api::shown(const intake::RequestHead& head) {
  return impl_->shown(head);
}

std::unique_ptr<intake::BodySink> Api::open(const intake::RequestHead& head,
                                            std::shared_ptr<intake::Responder> responder,
                                            std::shared_ptr<intake::Flow> flow) {
  return impl_->open(head, std::move(responder), std::move(flow));
}

void Api::let_in(std::vector<icd::BearerToken> tokens, icd::Redaction redaction) {
  impl_->let_in(std::move(tokens), std::move(redaction));
}

void Api::changed() {
  impl_->changed();
}

}  // namespace adit::api
