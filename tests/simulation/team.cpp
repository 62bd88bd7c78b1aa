#include "simulation/team.hpp"

#include "simulation/manners.hpp"
#include "simulation/messages.hpp"
#include "simulation/world.hpp"

namespace adit::simulation {
namespace {

constexpr int kMostPosts = 12;
constexpr std::int64_t kReportsOfOne = 1000;  // serials of one reporter

}  // namespace

Reporter::Reporter(World& world, int number)
    : world_(world),
      random_(world.random("reporter " + std::to_string(number))),
      client_(world, address(100 + number), manners(random_),
              world.random("client of reporter " + std::to_string(number))),
      twin_(world, address(110 + number), manners(random_),
            world.random("twin of reporter " + std::to_string(number))),
      twins_(random_.chance(0.3) ? 0.5 : 0),
      every_(random_.between(0.5, 10)),
      serial_(number * kReportsOfOne) {}

void Reporter::report_until(double end) {
  end_ = end;
  world_.after(seconds(random_.between(0, every_)), [this] {
    ++serial_;
    report();
  });
}

void Reporter::report() {
  if (world_.time() > end_) return;
  client_.ask(request_of({kReports, {{.who = "", .serial = serial_}}}, {.rounds = tries_ % 2 == 1}),
              {.what = kReports, .who = "", .serial = serial_}, [this](int status) { answered(status); });
  if (random_.chance(twins_)) world_.after(seconds(random_.between(0, 0.5)), [this] { report_too(); });
}

void Reporter::report_too() {
  if (!client_.busy() || twin_.busy()) return;
  twin_.ask(request_of({kReports, {{.who = "", .serial = serial_}}}, {.rounds = true}),
            {.what = kReports, .who = "", .serial = serial_}, [](int) {});
}

void Reporter::answered(int status) {
  const bool again = (status == 0 || status >= 500 || status == 429) && ++tries_ < kMostPosts;
  if (again) return world_.after(seconds(random_.between(0.05, 2)), [this] { report(); });
  tries_ = 0;
  ++serial_;
  world_.after(seconds(every_ * random_.between(0.2, 1.8)), [this] { report(); });
}

Team::Team(World& world, double until) {
  Random random = world.random("team");
  const auto robots = static_cast<int>(random.below(4)), reporters = static_cast<int>(random.below(3));
  for (int i = 1; i <= robots; ++i) robots_.push_back(std::make_unique<Robot>(world, i));
  for (int i = 1; i <= reporters; ++i) reporters_.push_back(std::make_unique<Reporter>(world, i));
  if (random.chance(0.4)) blunderers_.push_back(std::make_unique<Blunderer>(world, 1));
  for (std::uint64_t i = random.below(3); i > 0; --i)
    watchers_.push_back(std::make_unique<Watcher>(world, static_cast<int>(i)));
  if (random.chance(0.2)) stallers_.push_back(std::make_unique<Staller>(world));
  if (random.chance(0.15)) floods_.push_back(std::make_unique<Flood>(world, until));
  if (random.chance(0.15)) unauthenticated_.push_back(std::make_unique<UnauthenticatedClients>(world, until));
  if (world.random("whether there is a station").chance(0.3))
    station_ = std::make_unique<Station>(world, until);
  for (const auto& robot : robots_) robot->post_until(until);
  for (const auto& reporter : reporters_) reporter->report_until(until);
  for (const auto& blunderer : blunderers_) blunderer->post_until(until);
  for (const auto& watcher : watchers_) watcher->ask_until(until);
  for (const auto& staller : stallers_) staller->post_until(until);
}

}  // namespace adit::simulation
