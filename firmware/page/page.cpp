#include "page/page.hpp"

#include <utility>

#include "page/answers.hpp"
#include "page/live.hpp"
#include "page/map_routes.hpp"
#include "page/report_routes.hpp"
#include "page/site.hpp"

namespace adit::page {
namespace {

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

}  // namespace

class Page::Impl {
 public:
  Impl(loop::Loop& loop, const Source& source, Operator& judge, std::vector<icd::BearerToken> tokens)
      : source_(source),
        live_(loop, source),
        maps_(source),
        reports_(source, judge, std::move(tokens), [this] { live_.changed(); }) {}

  std::unique_ptr<intake::Exchange> open(const intake::RequestHead& head,
                                         std::shared_ptr<intake::Responder> responder) {
    if (ReportRoutes::has(head.path())) return reports_.open(head, std::move(responder));
    if (MapRoutes::has(head.path())) {
      responder->answer(maps_.answer(head));
    } else {
      show(head, *responder);
    }
    return nullptr;
  }

  void changed() { live_.changed(); }

 private:
  void show(const intake::RequestHead& head, intake::Responder& responder) {
    const auto* file = file_at(head.path());
    const bool is_run = head.path() == "/adit/run", is_events = head.path() == "/adit/events";
    const bool is_session = head.path() == "/adit/session";
    if (file == nullptr && !is_run && !is_events && !is_session) return responder.answer(nothing_here());
    if (!only_reads(head)) return responder.answer(wrong_method(kReading));
    if (is_session) {
      return responder.answer(
          fresh("application/json", "{\"role\":\"operator\",\"csrf\":null,\"first_start\":false}"));
    }
    if (file != nullptr) return responder.answer(answer_with(*file, head.header("If-None-Match")));
    if (is_run) return responder.answer(fresh("application/json", write_run_view(source_.view())));
    live_.open(responder);
  }

  const Source& source_;
  Live live_;
  MapRoutes maps_;
  ReportRoutes reports_;
};

Page::Page(loop::Loop& loop, const Source& source, Operator& judge, std::vector<icd::BearerToken> tokens)
    : impl_(std::make_unique<Impl>(loop, source, judge, std::move(tokens))) {}
Page::~Page() = default;

std::unique_ptr<intake::Exchange> Page::open(const intake::RequestHead& head,
                                             std::shared_ptr<intake::Responder> responder,
                                             std::shared_ptr<intake::Flow>) {
  return impl_->open(head, std::move(responder));
}

void Page::changed() {
  impl_->changed();
}

}  // namespace adit::page
