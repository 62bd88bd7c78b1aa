#include "api/scene_routes.hpp"

#include <cmath>

#include "api/answers.hpp"
#include "api/number_in.hpp"

namespace adit::api {
namespace {

constexpr std::string_view kMarkers = "/adit/markers", kTracks = "/adit/tracks";

}  // namespace

bool SceneRoutes::has(std::string_view path) {
  return path == kMarkers || path == kTracks;
}

intake::Answer SceneRoutes::answer(const intake::RequestHead& head) const {
  if (!only_reads(head)) return wrong_method(kReading);
  const std::string_view text = head.query("since");
  if (head.path() == kMarkers) {
    const auto since = text.empty() ? 0 : number_in<std::uint64_t>(text);
    if (!since) return refusal(icd::Status::BadRequest, "since: expected a version, a whole number");
    return fresh("application/json", write_markers(source_.markers(*since)));
  }
  const auto since = text.empty() ? 0 : number_in<double>(text);
  if (!since || !std::isfinite(*since)) {
    return refusal(icd::Status::BadRequest, "since: expected seconds since 1970");
  }
  return fresh("application/json", write_tracks(source_.tracks(*since)));
}

}  // namespace adit::api
