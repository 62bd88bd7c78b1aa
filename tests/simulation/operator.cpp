#include "simulation/operator.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "access/admission.hpp"
#include "access/sessions.hpp"
#include "admin/kept_file.hpp"
#include "admin/store.hpp"
#include "codec/json.hpp"
#include "host/service.hpp"
#include "settings/written.hpp"
#include "simulation/http.hpp"
#include "simulation/world.hpp"

namespace adit::simulation {
namespace {

access::Secret secret(Random& random) {
  access::Secret secret{};
  std::ranges::generate(secret, [&random] { return static_cast<std::uint8_t>(random.next()); });
  return secret;
}

}  // namespace

Operator::Operator(World& world, const Box& box, double until)
    : world_(world),
      box_(box),
      random_(world.random("changes of the operator")),
      client_(world, "10.0.0.10", {.keeps_alive = false, .patience = 20},
              world.random("client of the operator")) {
  Random random = world.random("operator");
  access::Sessions sessions;
  const auto& mine = sessions.begin(secret(random), secret(random), access::Role::Operator,
                                    {"10.0.0.10", "page"}, world.now());
  id_ = mine.id.reveal();
  csrf_ = mine.csrf.reveal();
  const access::KeptSessions kept{
      .boot = host::boot(), .last = sessions.last(), .sessions = sessions.entries()};
  if (!host::write_file(box.runtime() + '/' + admin::SessionKeeper::kFile, access::write_sessions(kept),
                        host::kOursAlone))
    std::abort();
  for (std::uint64_t i = random.chance(0.3) ? 1 + random.uniform_index(3) : 0; i > 0; --i)
    world.after(seconds(random.uniform(0.5, until)), [this] { save(); });
}

/// Changes one or several sections.
void Operator::change(settings::Settings& next) {
  next.reports.near_metres = next.reports.near_metres > 5 ? 5 : 6;
  if (random_.chance(0.5)) next.reports.review = static_cast<dispatch::Review>(random_.uniform_index(3));
  if (random_.chance(0.5)) next.reports.undo = std::chrono::seconds(random_.uniform_index(30));
  if (random_.chance(0.3))
    next.reports.answer_within = std::chrono::milliseconds(8000 + random_.uniform_index(12000));
  if (random_.chance(0.3))
    next.command_post.timeouts.connect = std::chrono::milliseconds(1000 + random_.uniform_index(3000));
  if (random_.chance(0.3)) next.command_post.budget_mbit = random_.uniform(20, 200);
  if (random_.chance(0.3))
    next.team.connections_per_address = static_cast<std::uint32_t>(4 + random_.uniform_index(5));
  if (random_.chance(0.3)) next.queues.map_bytes = (128u + random_.uniform_index(128)) << 20;
}

void Operator::save() {
  const auto loaded = admin::Store(box_.settings(), box_.secrets(), box_.state()).load();
  if (!loaded || client_.busy()) return;
  settings::Settings next = loaded->settings;
  change(next);
  const char* const name = next.reports.review == dispatch::Review::All ? kReviewAll : kReviewElse;
  const std::string body = codec::write_json({codec::Value::Object{
      {"base", {settings::tag_of(loaded->settings)}}, {"settings", settings::value_of(next)}}});
  const std::string headers =
      "Host: 10.0.0.1\r\nContent-Type: application/json\r\nCookie: " + std::string(access::kCookie) + "=" +
      id_ + "\r\n" + std::string(access::kCsrfHeader) + ": " + csrf_ + "\r\n";
  client_.ask(http_request("POST", kSettings, headers, body), {.what = kSettings, .who = kOperator},
              [this, name, undo = next.reports.undo.count()](int status) {
                if (status == 200)
                  world_.note({.kind = Kind::Saved, .what = name, .who = "", .serial = undo});
              });
}

}  // namespace adit::simulation
