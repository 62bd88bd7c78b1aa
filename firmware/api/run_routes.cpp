#include "api/run_routes.hpp"

#include "codec/body_decoder.hpp"
#include "codec/field.hpp"
#include "codec/json.hpp"
#include "codec/row.hpp"

namespace adit::api {
using codec::json;

intake::Answer RunRoutes::run() const {
  return fresh("application/json", codec::to_json(source_.view()));
}

void RunRoutes::events(const Call& call) {
  live_.open(*call.responder, entrance_.may_stay(call.asker));
}

intake::Answer RunRoutes::begin_run() {
  const std::int64_t number = operator_.begin_run();
  live_.changed();
  return object({{"run", json(number)}});
}

intake::Answer RunRoutes::begin_ledger() {
  const auto kept_as = operator_.begin_ledger();
  return kept_as ? object({{"kept_as", json(*kept_as)}}) : refused(kept_as.error());
}

intake::Answer RunRoutes::rejected(std::uint64_t number, RejectedAction action) {
  const auto done = operator_.rejected(number, action);
  live_.changed();
  return done ? object({{"rejected", json(number)}}) : refusal(icd::Status::Conflict, done.error());
}

intake::Answer RunRoutes::acknowledge(const std::string& body) {
  const auto document = codec::decode({}, codec::Split::Nothing, body);
  if (!document) return refused(document.error());
  codec::Reading reading;
  const codec::Field root(document->root, reading);
  const auto id = reading.outcome(std::string(root.member("id").text()));
  if (!id) return refused(id.error());
  const auto done = operator_.acknowledge(*id);
  live_.changed();
  return done ? object({{"acknowledged", json(*id)}}) : refusal(icd::Status::Conflict, done.error());
}

intake::Answer RunRoutes::identify(const std::string& body) {
  const auto document = codec::decode({}, codec::Split::Nothing, body);
  if (!document) return refused(document.error());
  codec::Reading reading;
  const codec::Field root(document->root, reading);
  const auto seconds = reading.outcome(root.member("seconds").number(kLeast, kMost));
  if (!seconds) return refused(seconds.error());
  return object({{"identify_until", json(operator_.identify(*seconds))}});
}

}  // namespace adit::api
