#include "api/api.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "access/admission.hpp"
#include "api/answers.hpp"
#include "api/certificate.hpp"
#include "api/route.hpp"
#include "codec/body_decoder.hpp"
#include "icd/sentence.hpp"
#include "icd/text.hpp"

namespace adit::api {
namespace {

/// The refusal of a body by its headers, or std::nullopt.
std::optional<intake::Answer> check_headers(const Body& body, const intake::RequestHead& head) {
  if (body.type.empty()) return std::nullopt;
  const std::string_view type = head.header("Content-Type");
  const bool fits = body.as_it_comes ? type == body.type : codec::format_of(type) == codec::Format::Json;
  if (!fits) {
    return refusal(icd::Status::UnprocessableEntity, icd::sentence("Content-Type: expected ", body.type));
  }
  if (head.content_length().value_or(0) <= body.most) return std::nullopt;
  return SmallBody::too_long(body.most, body.as_it_comes ? "file" : "body");
}

SharedRedaction share_redaction(icd::Redaction redaction) {
  return std::make_shared<icd::Redaction>(std::move(redaction));
}

}  // namespace

Api::Api(loop::Loop& loop, const ApiServices& served, std::vector<icd::BearerToken> tokens,
         icd::Redaction redaction)
    : setup_(served.setup),
      certificate_(served.certificate),
      redaction_(std::make_shared<SharedRedaction>(share_redaction(std::move(redaction)))),
      authenticator_(loop, served.keys, std::move(tokens)),
      live_(loop, served.source),
      sessions_(loop, authenticator_, served.keys, served.setup, served.certificate),
      run_(served.source, served.decisions, served.gateway_control, live_, authenticator_),
      maps_(served.source, served.finer, served.covered),
      lists_(loop, served.source),
      reports_(lists_, served.source, served.decisions),
      box_(served.source, lists_, served.box, served.keys, loop),
      kept_(loop, served.runs, served.source),
      handlers_(&pages_, &sessions_, &run_, &maps_, &reports_, &box_, &kept_, &served.certificate,
                &served.clock, &served.network, &served.test, &served.setup, &served.spare, &served.updates) {
}

std::unique_ptr<intake::BodySink> Api::open(const intake::RequestHead& head,
                                            std::shared_ptr<intake::Responder> asked_by,
                                            std::shared_ptr<intake::FlowControl> flow) {
  auto responder = redact_answers(std::move(asked_by), redaction_, head);
  const auto answer_with = [&responder](intake::Answer answer) {
    responder->answer(std::move(answer));
    return nullptr;
  };
  if (auto elsewhere = redirect_to_https(head)) return answer_with(*std::move(elsewhere));
  Match found = match(head);
  if (found.allowed.empty() && !found.route && !head.path().starts_with(intake::kApiPaths)) {
    return answer_with(pages_.file(head));
  }
  const auto asker = authenticator_.admit(head, found.who);
  if (!asker) return answer_with(rejection_answer(asker.error()));
  if (!found.route)
    return answer_with(found.allowed.empty() ? refusal_answer(nothing_at(head.path()))
                                             : wrong_method(found.allowed));
  const Route& route = *found.route;
  if (auto why = check_headers(route.body, head)) return answer_with(std::move(*why));
  Call call{.head = head,
            .responder = std::move(responder),
            .flow = std::move(flow),
            .asker = *asker,
            .parameters = std::move(found.parameters),
            .redaction = *redaction_,
            .body = {}};
  if (route.handle.begin != nullptr) return route.handle.begin(handlers_, call);
  if (route.handle.answer != nullptr && route.body.type.empty()) {
    handle(route, call);
    return nullptr;
  }
  return std::make_unique<SmallBody>(call.responder, route.body.most,
                                     [this, &route, call](std::string body) mutable {
                                       call.body = std::move(body);
                                       handle(route, call);
                                     });
}

/// A page is redirected. The API is not: its client has already sent the password or the session, and a page
/// that was open before logs in again. A script has shown its token already, and may know no TLS.
std::optional<intake::Answer> Api::redirect_to_https(const intake::RequestHead& head) const {
  const std::string_view host = head.header("Host"), path = head.path();
  if (head.is_secure() || is_from_this_machine(head) || !head.header("Authorization").empty())
    return std::nullopt;
  if (!setup_.settings().page.https_only || !access::names_this_box(host) || !certificate_.state().offered)
    return std::nullopt;
  const std::size_t name = host.starts_with('[') ? host.find(']') + 1 : host.find(':');
  const std::string box = icd::sentence("https://", host.substr(0, name));
  if (path.starts_with(intake::kApiPaths) || path == "/metrics" || !is_read_only(head))
    return rejection_answer({icd::Status::Unauthorized, icd::sentence("log in by HTTPS: ", box)});
  intake::Answer answer{
      .status = kPermanentRedirect, .content_type = "text/plain", .body = box + '\n', .headers = {}};
  // The path was decoded: only a plain one is safe in a header.
  const bool is_plain = std::ranges::all_of(
      path, [](char c) { return icd::is_letter_or_digit(c) || c == '/' || c == '_' || c == '.'; });
  answer.headers.push_back({"Location", icd::sentence(box, is_plain ? path : "/")});
  answer.headers.push_back({"Cache-Control", "no-store"});  // the setting may change
  return add_headers(std::move(answer));
}

void Api::set_tokens(std::vector<icd::BearerToken> tokens, icd::Redaction redaction) {
  authenticator_.set_tokens(std::move(tokens));
  *redaction_ = share_redaction(std::move(redaction));
}

/// A POST may change open pages.
void Api::handle(const Route& route, const Call& call) {
  if (route.method == "POST") live_.on_changed();
  if (route.handle.answer == nullptr) return route.handle.answer_later(handlers_, call);
  call.responder->answer(route.handle.answer(handlers_, call));
}

}  // namespace adit::api
