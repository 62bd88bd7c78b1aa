#include "page/page.hpp"

#include <utility>

#include "intake/icd_routes.hpp"
#include "page/live.hpp"
#include "page/site.hpp"

namespace adit::page {
namespace {

constexpr auto kNotModified = static_cast<icd::Status>(304);  // RFC 9110 15.4.5; no ICD answer has it

/// Nothing but the page's own files may be loaded or called, and nothing may frame it.
constexpr const char* kContentSecurityPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; connect-src 'self'; "
    "base-uri 'none'; frame-ancestors 'none'; form-action 'none'";

intake::Answer guarded(intake::Answer answer) {
  answer.headers.push_back({"Content-Security-Policy", kContentSecurityPolicy});
  answer.headers.push_back({"X-Content-Type-Options", "nosniff"});
  answer.headers.push_back({"Referrer-Policy", "no-referrer"});
  return answer;
}

intake::Answer answer_with(const File& file, std::string_view if_none_match) {
  intake::Answer answer{.content_type = std::string(content_type_of(file)), .body = {}, .headers = {}};
  answer.headers.push_back({"ETag", std::string(file.etag)});
  answer.headers.push_back({"Cache-Control", "no-cache"});  // asked for each time, sent only where it changed
  if (if_none_match.contains(file.etag)) {
    answer.status = kNotModified;
  } else {
    answer.body = file.body;
  }
  return guarded(std::move(answer));
}

intake::Answer answer_with(const RunView& view) {
  return guarded({.body = write_run_view(view), .headers = {{"Cache-Control", "no-store"}}});
}

intake::Answer refusal(icd::Status status, std::string_view sentence) {
  return guarded(intake::error_answer(status, sentence));
}

}  // namespace

class Page::Impl {
 public:
  Impl(loop::Loop& loop, const Source& source, Operator& judge, std::vector<icd::BearerToken> tokens)
      : source_(source), judge_(judge), tokens_(std::move(tokens)), live_(loop, source) {}

  void serve(const intake::RequestHead& head, intake::Responder& responder) {
    const auto* file = file_at(head.path());
    const bool is_run = head.path() == "/adit/run", is_events = head.path() == "/adit/events";
    if (file == nullptr && !is_run && !is_events) {
      return responder.answer(refusal(icd::Status::NotFound, "there is nothing at this path"));
    }
    if (head.method() != "GET" && head.method() != "HEAD") {
      auto answer = refusal(icd::Status::MethodNotAllowed, "expected GET");
      answer.headers.push_back({"Allow", "GET, HEAD"});
      return responder.answer(std::move(answer));
    }
    if (file != nullptr) return responder.answer(answer_with(*file, head.header("If-None-Match")));
    if (is_run) return responder.answer(answer_with(source_.view()));
    live_.open(responder);
  }

  void changed() { live_.changed(); }

 private:
  const Source& source_;
  [[maybe_unused]] Operator& judge_;
  std::vector<icd::BearerToken> tokens_;
  Live live_;
};

Page::Page(loop::Loop& loop, const Source& source, Operator& judge, std::vector<icd::BearerToken> tokens)
    : impl_(std::make_unique<Impl>(loop, source, judge, std::move(tokens))) {}
Page::~Page() = default;

std::unique_ptr<intake::Exchange> Page::open(const intake::RequestHead& head,
                                             std::shared_ptr<intake::Responder> responder,
                                             std::shared_ptr<intake::Flow>) {
  impl_->serve(head, *responder);
  return nullptr;
}

void Page::changed() {
  impl_->changed();
}

}  // namespace adit::page
