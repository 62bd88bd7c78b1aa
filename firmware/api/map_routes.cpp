#include "api/map_routes.hpp"

#include "api/answers.hpp"
#include "api/asked_number.hpp"
#include "api/map_json.hpp"
#include "api/map_tile.hpp"

namespace adit::api {

intake::Answer MapRoutes::layers(const intake::RequestHead& head) const {
  const auto since = version_asked(head);
  if (!since) return since.error();
  return fresh("application/json", codec::to_json(map_view(source_.map(), *since)));
}

intake::Answer MapRoutes::markers(const intake::RequestHead& head) const {
  const auto since = version_asked(head);
  if (!since) return since.error();
  return fresh("application/json", codec::to_json(source_.markers(*since)));
}

intake::Answer MapRoutes::tracks(const intake::RequestHead& head) const {
  const AskedNumber since = asked_number(head, "since");
  if (since.wrong) return refusal(icd::Status::BadRequest, "since: expected seconds since 1970");
  return fresh("application/json", codec::to_json(Tracks{source_.tracks(since.number.value_or(0))}));
}

intake::Answer MapRoutes::tile(const Call& call) const {
  const auto asked = tile_asked(call.head, call.parameters);
  return asked ? tile_of(source_.map(), *asked) : asked.error();
}

}  // namespace adit::api
