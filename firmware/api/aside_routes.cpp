#include "api/aside_routes.hpp"

#include <optional>
#include <string>
#include <utility>

#include "api/answers.hpp"
#include "api/number_in.hpp"
#include "api/small_body.hpp"
#include "codec/body_decoder.hpp"

namespace adit::api {
namespace {

constexpr std::size_t kMostBody = 1024;

struct Wanted {
  std::uint64_t number = 0;
  AsideAction action = AsideAction::Send;
};

std::optional<Wanted> wanted_at(std::string_view path) {
  path.remove_prefix(std::string_view("/adit/aside/").size());
  const auto slash = path.find('/');
  if (slash == std::string_view::npos) return std::nullopt;
  const auto number = number_in<std::uint64_t>(path.substr(0, slash));
  const std::string_view word = path.substr(slash + 1);
  if (!number || (word != "send" && word != "discard")) return std::nullopt;
  return Wanted{*number, word == "send" ? AsideAction::Send : AsideAction::Discard};
}

}  // namespace

std::unique_ptr<intake::BodySink> AsideRoutes::open(const intake::RequestHead& head,
                                                    std::shared_ptr<intake::Responder> responder) {
  const auto refuse = [&responder](intake::Answer answer) {
    responder->answer(std::move(answer));
    return nullptr;
  };
  const auto wanted = wanted_at(head.path());
  if (!wanted) return refuse(nothing_here());
  if (head.method() != "POST") return refuse(wrong_method("POST"));
  if (codec::format_of(head.header("Content-Type")) != codec::Format::Json) {
    return refuse(refusal(icd::Status::UnprocessableEntity, "Content-Type: expected application/json"));
  }
  if (head.content_length().value_or(0) > kMostBody) return refuse(SmallBody::too_long(kMostBody));
  return std::make_unique<SmallBody>(
      responder, kMostBody, [this, wanted = *wanted, responder](const std::string&) {
        const auto done = operator_.aside(wanted.number, wanted.action);
        changed_();
        responder->answer(done
                              ? fresh("application/json", "{\"aside\":" + std::to_string(wanted.number) + "}")
                              : refusal(icd::Status::Conflict, done.error()));
      });
}

}  // namespace adit::api
