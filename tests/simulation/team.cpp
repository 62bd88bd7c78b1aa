#include "simulation/team.hpp"

#include <algorithm>

#include "simulation/manners.hpp"
#include "simulation/messages.hpp"
#include "simulation/world.hpp"

namespace adit::simulation {
namespace {

constexpr int kMostPosts = 12;
constexpr std::int64_t kReportsOfOne = 1000;  // serials of one reporter
constexpr int kOfABurst = 12;                 // reports
constexpr std::int64_t kSerialsOfABurst = 7000;

}  // namespace

Reporter::Reporter(World& world, int number)
    : world_(world),
      random_(world.random("reporter " + std::to_string(number))),
      client_(world, address(100 + number), manners(random_),
              world.random("client of reporter " + std::to_string(number))),
      twin_(world, address(110 + number), manners(random_),
            world.random("twin of reporter " + std::to_string(number))),
      twins_(random_.chance(0.3) ? 0.5 : 0),
      repeating_(world.random("repeats of reporter " + std::to_string(number))),
      repeats_(repeating_.chance(0.4) ? 0.4 : 0),
      every_(random_.uniform(0.5, 10)),
      first_(number * kReportsOfOne + 1),
      serial_(number * kReportsOfOne) {}

void Reporter::report_until(double end) {
  end_ = end;
  world_.after(seconds(random_.uniform(0, every_)), [this] {
    ++serial_;
    report();
  });
}

void Reporter::report() {
  if (world_.time() > end_) return;
  client_.ask(request_of({kReports, {{.who = "", .serial = serial_}}}, {.rounds = tries_ % 2 == 1}),
              {.what = kReports, .who = "", .serial = serial_}, [this](int status) { answered(status); });
  if (random_.chance(twins_)) world_.after(seconds(random_.uniform(0, 0.5)), [this] { report_too(); });
}

void Reporter::report_too() {
  if (!client_.busy() || twin_.busy()) return;
  twin_.ask(request_of({kReports, {{.who = "", .serial = serial_}}}, {.rounds = true}),
            {.what = kReports, .who = "", .serial = serial_}, [](int) {});
}

/// One of the last five reports that were answered.
void Reporter::report_again() {
  const auto back = 1 + static_cast<std::int64_t>(repeating_.uniform_index(5));
  const std::int64_t serial = std::max(first_, serial_ - back);
  if (world_.time() > end_ || twin_.busy() || serial == serial_) return;
  twin_.ask(request_of({kReports, {{.who = "", .serial = serial}}}, {}),
            {.what = kReports, .who = "", .serial = serial}, [](int) {});
}

void Reporter::answered(int status) {
  const bool again = (status == 0 || status >= 500 || status == 429) && ++tries_ < kMostPosts;
  if (again) return world_.after(seconds(random_.uniform(0.05, 2)), [this] { report(); });
  tries_ = 0;
  ++serial_;
  if (repeating_.chance(repeats_))
    world_.after(seconds(repeating_.uniform(0, 8)), [this] { report_again(); });
  world_.after(seconds(every_ * random_.uniform(0.2, 1.8)), [this] { report(); });
}

Burst::Burst(World& world, double until)
    : world_(world),
      random_(world.random("burst")),
      watching_(world, address(150), {.patience = 3}, world.random("watcher of the burst")) {
  for (int i = 0; i < kOfABurst; ++i) {
    reporting_.push_back(std::make_unique<Client>(world, address(151 + i / 4), Manners{.patience = 30},
                                                  world.random("burst " + std::to_string(i))));
  }
  world.after(seconds(random_.uniform(0, until)), [this] { begin(); });
}

void Burst::begin() {
  ends_ = world_.time() + kOfABurst + 3;
  for (std::size_t i = 0; i < reporting_.size(); ++i) {
    const std::int64_t serial = kSerialsOfABurst + static_cast<std::int64_t>(i);
    const double when = random_.uniform(0, 0.5);
    world_.after(seconds(when), [this, i, serial] {
      reporting_[i]->ask(request_of({kReports, {{.who = "", .serial = serial}}}, {}),
                         {.what = kReports, .who = "", .serial = serial}, [](int) {});
    });
  }
  watch();
}

void Burst::watch() {
  if (world_.time() > ends_) return;
  watching_.ask(status_request(), {.what = kStatus, .who = "burst"},
                [this](int) { world_.after(seconds(0.5), [this] { watch(); }); });
}

LateReporter::LateReporter(World& world, double trouble_for)
    : world_(world),
      client_(world, address(120), {.keeps_alive = false, .patience = 5},
              world.random("client of the late reporter")) {
  Random random = world.random("late reporter");
  const bool reports = random.chance(1.0 / 3);
  const double late = random.uniform(45, 60);
  if (!reports || world.omits("late")) return;
  world.after(seconds(trouble_for + late), [this] { report(); });
}

void LateReporter::report() {
  client_.ask(request_of({kReports, {{.who = "", .serial = kSerial}}}, {}),
              {.what = kReports, .who = "", .serial = kSerial}, [](int) {});
}

Team::Team(World& world, double until) : late_reporter_(world, until) {
  Random random = world.random("team");
  const auto drawn = static_cast<int>(random.uniform_index(4)),
             reporters = static_cast<int>(random.uniform_index(3));
  const int robots = world.has_large_maps() ? std::max(drawn, 1) : drawn;
  for (int i = 1; i <= robots; ++i) robots_.push_back(std::make_unique<Robot>(world, i));
  for (int i = 1; i <= reporters; ++i) reporters_.push_back(std::make_unique<Reporter>(world, i));
  if (random.chance(0.4)) blunderers_.push_back(std::make_unique<Blunderer>(world, 1));
  for (std::uint64_t i = random.uniform_index(3); i > 0; --i)
    watchers_.push_back(std::make_unique<Watcher>(world, static_cast<int>(i)));
  if (random.chance(0.2)) stallers_.push_back(std::make_unique<Staller>(world));
  if (random.chance(0.15)) floods_.push_back(std::make_unique<Flood>(world, until));
  if (random.chance(0.15)) unauthenticated_.push_back(std::make_unique<UnauthenticatedClients>(world, until));
  if (world.random("whether there is a station").chance(0.3))
    station_ = std::make_unique<Station>(world, until);
  if (world.random("whether there is a burst").chance(0.25)) burst_ = std::make_unique<Burst>(world, until);
  for (const auto& robot : robots_) robot->post_until(until);
  for (const auto& reporter : reporters_) reporter->report_until(until);
  for (const auto& blunderer : blunderers_) blunderer->post_until(until);
  for (const auto& watcher : watchers_) watcher->ask_until(until);
  for (const auto& staller : stallers_) staller->post_until(until);
}

}  // namespace adit::simulation
