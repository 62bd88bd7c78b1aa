#include "api/run_routes.hpp"

#include "api/read_body.hpp"
#include "codec/row.hpp"

namespace adit::api {
using codec::json;

intake::Answer RunRoutes::run() const {
  return fresh(source_.view());
}

std::unique_ptr<intake::BodySink> RunRoutes::events(const Call& call) {
  live_.open(*call.responder, entrance_.may_stay(call.asker));
  return nullptr;
}

intake::Answer RunRoutes::begin_run() {
  return object({{"run", json(operator_.begin_run())}});
}

intake::Answer RunRoutes::begin_ledger() {
  const auto kept_as = caretaker_.begin_ledger();
  return kept_as ? object({{"kept_as", json(*kept_as)}}) : refused(kept_as.error());
}

intake::Answer RunRoutes::rejected(std::uint64_t number, RejectedAction action) {
  const auto done = operator_.rejected(number, action);
  return done ? object({{"rejected", json(number)}}) : refusal(icd::Status::Conflict, done.error());
}

intake::Answer RunRoutes::acknowledge(const std::string& body) {
  const auto id = read_text(body, "id");
  if (!id) return refused(id.error());
  const auto done = caretaker_.acknowledge(*id);
  return done ? object({{"acknowledged", json(*id)}}) : refusal(icd::Status::Conflict, done.error());
}

intake::Answer RunRoutes::identify(const std::string& body) {
  const auto seconds = read_body<double>(
      body, [](const codec::Field& root) { return root.member("seconds").number(kLeast, kMost); });
  if (!seconds) return refused(seconds.error());
  return object({{"identify_until", json(caretaker_.identify(*seconds))}});
}

}  // namespace adit::api
