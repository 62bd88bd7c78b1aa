#include "api/clock_routes.hpp"

#include "api/answers.hpp"
#include "api/read_body.hpp"
#include "codec/row.hpp"

namespace adit::api {

intake::Answer ClockRoutes::shown() const {
  return fresh("application/json", codec::to_json(clock_.clock()));
}

intake::Answer ClockRoutes::set(const std::string& body) {
  const auto time =
      read_body<double>(body, [](const codec::Field& root) { return root.member("time").number(); });
  if (!time) return refused(time.error());
  const auto done = clock_.set_clock(*time);
  return done ? shown() : refused(done.error());
}

}  // namespace adit::api
