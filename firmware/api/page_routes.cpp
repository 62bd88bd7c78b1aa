#include "api/page_routes.hpp"

#include <functional>
#include <utility>

#include "api/answers.hpp"
#include "api/description.hpp"
#include "api/routes.hpp"
#include "icd/sentence.hpp"
#include "site/site.hpp"

namespace adit::api {
namespace {

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

intake::Answer PageRoutes::file(const intake::RequestHead& head) {
  const auto* const file = site::file_at(head.path());
  if (file == nullptr) return nothing_here();
  return only_reads(head) ? answer_with(*file, head.header("If-None-Match")) : wrong_method(kReading);
}

intake::Answer PageRoutes::description(const intake::RequestHead& head) {
  if (description_.empty()) {
    description_ = write_description(routes());
    description_etag_ = icd::sentence("\"", std::hash<std::string>{}(description_), "\"");
  }
  return answer_with({"/openapi.json", description_etag_, description_}, head.header("If-None-Match"));
}

}  // namespace adit::api
