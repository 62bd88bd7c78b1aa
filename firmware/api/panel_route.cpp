#include "api/panel_route.hpp"

#include <utility>

#include "api/answers.hpp"
#include "api/as_json.hpp"
#include "api/small_body.hpp"
#include "codec/body_decoder.hpp"
#include "codec/field.hpp"
#include "codec/json.hpp"

namespace adit::api {
namespace {

constexpr std::size_t kMostBody = 1024;

}  // namespace

std::unique_ptr<intake::BodySink> PanelRoute::open(const intake::RequestHead& head,
                                                   std::shared_ptr<intake::Responder> responder) {
  const auto refuse = [&responder](intake::Answer answer) {
    responder->answer(std::move(answer));
    return nullptr;
  };
  if (head.method() != "POST") return refuse(wrong_method("POST"));
  if (codec::format_of(head.header("Content-Type")) != codec::Format::Json) {
    return refuse(refusal(icd::Status::UnprocessableEntity, "Content-Type: expected application/json"));
  }
  if (head.content_length().value_or(0) > kMostBody) return refuse(SmallBody::too_long(kMostBody));
  return std::make_unique<SmallBody>(responder, kMostBody, [this, responder](const std::string& body) {
    responder->answer(identify(body));
  });
}

intake::Answer PanelRoute::identify(std::string_view body) {
  const auto document = codec::decode({}, codec::Split::Nothing, body);
  if (!document) return refusal(document.error().status, document.error().sentence);
  codec::Reading reading;
  const codec::Field root(document->root, reading);
  const auto seconds = reading.outcome(root.member("seconds").number(kLeast, kMost));
  if (!seconds) return refusal(seconds.error().status, seconds.error().sentence);
  const Time until = operator_.identify(*seconds);
  return fresh("application/json",
               codec::write_json({codec::Value::Object{{"identify_until", json(until)}}}));
}

}  // namespace adit::api
