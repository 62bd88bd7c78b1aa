#include "api/api.hpp"

#include <optional>
#include <utility>

#include "api/answers.hpp"
#include "api/aside_routes.hpp"
#include "api/box_routes.hpp"
#include "api/description.hpp"
#include "api/entrance.hpp"
#include "api/live.hpp"
#include "api/map_routes.hpp"
#include "api/network_routes.hpp"
#include "api/panel_route.hpp"
#include "api/report_routes.hpp"
#include "api/scene_routes.hpp"
#include "api/session_routes.hpp"
#include "api/settings_routes.hpp"
#include "api/update_routes.hpp"
#include "site/site.hpp"

namespace adit::api {
namespace {

constexpr std::string_view kGuarded = "/adit/";  // and kMetrics; all else is the page's own files
constexpr std::string_view kMetrics = "/metrics", kApi = "/adit/openapi.json";

intake::Answer answer_with(const site::File& file, std::string_view if_none_match) {
  intake::Answer answer{.content_type = std::string(site::content_type_of(file)), .body = {}, .headers = {}};
  answer.headers.push_back({"ETag", std::string(file.etag)});
  answer.headers.push_back({"Cache-Control", "no-cache"});  // asked for each time, sent only where it changed
  if (if_none_match.contains(file.etag)) {
    answer.status = kNotModified;
  } else {
    answer.body = file.body;
  }
  return guarded(std::move(answer));
}

}  // namespace

class Api::Impl {
 public:
  Impl(loop::Loop& loop, const Source& source, Operator& judge, Keys& keys,
       std::vector<icd::BearerToken> tokens)
      : loop_(loop),
        source_(source),
        entrance_(loop, keys.sessions(), std::move(tokens)),
        sessions_(loop, entrance_, keys),
        live_(loop, source),
        maps_(source),
        scene_(source),
        panel_(judge),
        reports_(source, judge, [this] { live_.changed(); }),
        aside_(judge, [this] { live_.changed(); }) {}

  std::unique_ptr<intake::BodySink> open(const intake::RequestHead& head,
                                         std::shared_ptr<intake::Responder> responder,
                                         std::shared_ptr<intake::Flow> flow) {
    if (!is_guarded(head.path())) {
      responder->answer(file(head));
      return nullptr;
    }
    if (box_ && BoxRoutes::has(head.path())) return box_->open(head, responder);
    if (SessionRoutes::has(head.path())) return sessions_.open(head, std::move(responder));
    const bool sets_up = settings_ && SettingsRoutes::has(head.path());
    const bool for_viewers = only_reads(head) && (!sets_up || SettingsRoutes::is_for_viewers(head.path()));
    const auto visitor = entrance_.admit(head, for_viewers ? access::Role::Viewer : access::Role::Operator);
    if (!visitor) {
      responder->answer(turned_away(visitor.error()));
      return nullptr;
    }
    if (sets_up) return settings_->open(head, std::move(responder));
    if (ReportRoutes::has(head.path())) return reports_.open(head, std::move(responder));
    if (AsideRoutes::has(head.path())) return aside_.open(head, std::move(responder));
    if (PanelRoute::has(head.path())) return panel_.open(head, std::move(responder));
    if (network_ && NetworkRoutes::has(head.path())) return network_->open(head, std::move(responder));
    if (updates_ && UpdateRoutes::has(head.path())) return updates_->open(head, responder, std::move(flow));
    if (MapRoutes::has(head.path())) {
      responder->answer(maps_.answer(head));
    } else if (SceneRoutes::has(head.path())) {
      responder->answer(scene_.answer(head));
    } else {
      show(head, *visitor, *responder);
    }
    return nullptr;
  }

  void serve(Setup& setup) {
    settings_.emplace(setup);
    sessions_.serve(setup);
  }
  void serve(Network& network, SelfTest& test) {
    network_.emplace(network, test, [this] { live_.changed(); });
  }
  void serve(Updates& updates) {
    updates_.emplace(updates, [this] { live_.changed(); });
  }
  void serve(Box& box) { box_.emplace(source_, box, entrance_, loop_); }
  void changed() { live_.changed(); }
  void let_in(std::vector<icd::BearerToken> tokens) { entrance_.let_in(std::move(tokens)); }

 private:
  static bool is_guarded(std::string_view path) {
    return path == kMetrics || (path.starts_with(kGuarded) && path != kApi);
  }

  static intake::Answer file(const intake::RequestHead& head) {
    const auto* file = head.path() == kApi ? &open_api::description() : site::file_at(head.path());
    if (file == nullptr) return nothing_here();
    return only_reads(head) ? answer_with(*file, head.header("If-None-Match")) : wrong_method(kReading);
  }

  void show(const intake::RequestHead& head, const access::Visitor& visitor, intake::Responder& responder) {
    const bool is_run = head.path() == "/adit/run", is_events = head.path() == "/adit/events";
    if (!is_run && !is_events) return responder.answer(nothing_here());
    if (!only_reads(head)) return responder.answer(wrong_method(kReading));
    if (is_run) return responder.answer(fresh("application/json", write_run_view(source_.view())));
    live_.open(responder, entrance_.may_stay(visitor));
  }

  loop::Loop& loop_;
  const Source& source_;
  Entrance entrance_;
  SessionRoutes sessions_;
  std::optional<BoxRoutes> box_;
  Live live_;
  MapRoutes maps_;
  SceneRoutes scene_;
  PanelRoute panel_;
  std::optional<NetworkRoutes> network_;
  std::optional<UpdateRoutes> updates_;
  ReportRoutes reports_;
  AsideRoutes aside_;
  std::optional<SettingsRoutes> settings_;
};

Api::Api(loop::Loop& loop, const Source& source, Operator& judge, Keys& keys,
         std::vector<icd::BearerToken> tokens)
    : impl_(std::make_unique<Impl>(loop, source, judge, keys, std::move(tokens))) {}
Api::~Api() = default;

void Api::serve(Setup& setup) {
  impl_->serve(setup);
}

std::unique_ptr<intake::BodySink> Api::open(const intake::RequestHead& head,
                                            std::shared_ptr<intake::Responder> responder,
                                            std::shared_ptr<intake::Flow> flow) {
  return impl_->open(head, std::move(responder), std::move(flow));
}

void Api::serve(Box& box) {
  impl_->serve(box);
}

void Api::serve(Updates& updates) {
  impl_->serve(updates);
}

void Api::serve(Network& network, SelfTest& test) {
  impl_->serve(network, test);
}

void Api::let_in(std::vector<icd::BearerToken> tokens) {
  impl_->let_in(std::move(tokens));
}
void Api::changed() {
  impl_->changed();
}

}  // namespace adit::api
