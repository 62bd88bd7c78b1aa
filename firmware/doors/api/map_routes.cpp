#include "api/map_routes.hpp"

#include "api/answers.hpp"
#include "api/map_json.hpp"
#include "api/map_tile.hpp"
#include "api/number_in.hpp"
#include "api/thinned.hpp"

namespace adit::api {

intake::Answer MapRoutes::layers(const intake::RequestHead& head) const {
  const auto since = version_asked(head);
  if (!since) return since.error();
  MapView view = map_view(source_.map(), *since);
  for (picture::LayerView& layer : view.layers) layer.finer = finer_.finer(layer.layer, *since);
  return fresh(view);
}

intake::Answer MapRoutes::markers(const intake::RequestHead& head) const {
  const auto since = version_asked(head);
  if (!since) return since.error();
  return fresh(source_.markers(*since));
}

intake::Answer MapRoutes::tracks(const intake::RequestHead& head) const {
  const AskedNumber since = asked_number(head, "since");
  if (since.wrong) return refusal(icd::Status::BadRequest, "since: expected seconds since 1970");
  return fresh(thinned(source_.tracks(since.number.value_or(0))));
}

void MapRoutes::tile(const Call& call) const {
  const auto asked = tile_asked(call.head, call.parameters);
  if (!asked) return call.responder->answer(asked.error());
  if (asked->at.level >= 0 || !picture::is_in_world(asked->at))
    return call.responder->answer(tile_of(source_.map(), *asked));
  finer_.tile(asked->layer, asked->at,
              [responder = call.responder, asked = *asked](const icd::Checked<picture::Tile>& tile) {
                responder->answer(tile ? finer_tile(*tile, asked) : refused(tile.error()));
              });
}

void MapRoutes::covered(const Call& call) const {
  covered_.covered([responder = call.responder](const icd::Checked<picture::Covered>& covered) {
    responder->answer(covered ? fresh(covered_view(*covered)) : refused(covered.error()));
  });
}

}  // namespace adit::api
