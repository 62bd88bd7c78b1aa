#include "api/map_routes.hpp"

#include <utility>

#include "api/answers.hpp"
#include "api/asked_number.hpp"
#include "api/map_json.hpp"
#include "api/map_tile.hpp"
#include "api/small_body.hpp"

namespace adit::api {

intake::Answer MapRoutes::layers(const intake::RequestHead& head) const {
  const auto since = version_asked(head);
  if (!since) return since.error();
  MapView view = map_view(source_.map(), *since);
  for (picture::LayerView& layer : view.layers) layer.finer = finer_.finer(layer.layer, *since);
  return fresh("application/json", codec::to_json(view));
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

/// What is drawn is answered from the head alone. What is answered later needs something that takes the body,
/// although there is none.
std::unique_ptr<intake::BodySink> MapRoutes::tile(const Call& call) const {
  auto asked = tile_asked(call.head, call.parameters);
  if (!asked || asked->at.level >= 0 || !picture::is_in_world(asked->at)) {
    call.responder->answer(asked ? tile_of(source_.map(), *asked) : asked.error());
    return nullptr;
  }
  return std::make_unique<SmallBody>(
      call.responder, 0, [this, responder = call.responder, asked = *std::move(asked)](const std::string&) {
        finer_.tile(asked.layer, asked.at, [responder, asked](const icd::Checked<picture::Tile>& tile) {
          responder->answer(tile ? finer_tile(*tile, asked)
                                 : refusal(tile.error().status, tile.error().sentence));
        });
      });
}

}  // namespace adit::api
