// Promise 1 holds for random clients, faults and power cuts in simulated time.
#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>

#include "dispatch/model/world.hpp"

namespace adit::dispatch::model {
namespace {

struct Profile {
  const char* name;
  Trouble trouble;
};
void PrintTo(const Profile& profile, std::ostream* out) {
  *out << profile.name;
}

constexpr Trouble kFaults{.answer_lost = 0.1,
                          .request_lost = 0.1,
                          .late = 0.05,
                          .never_left = 0.05,
                          .throttled = 0.1,
                          .barred = 0.02,
                          .refused = 0.02,
                          .server_error = 0.1,
                          .status_fails = 0.1};

Trouble with(Trouble trouble, void (*change)(Trouble&)) {
  change(trouble);
  return trouble;
}

const Profile kProfiles[] = {
    {"Calm", {}},
    {"Faults", kFaults},
    {"PowerCuts", with(kFaults, [](Trouble& trouble) { trouble.power_cut = 0.05; })},
    {"FullDisk", with(kFaults, [](Trouble& trouble) { trouble.disk_full = 0.3; })},
    {"OtherSender", with(kFaults, [](Trouble& trouble) { trouble.other_sender = true; })},
    {"AdminStops", with(kFaults, [](Trouble& trouble) { trouble.admin_stops = true; })},
    {"NewRuns", with(kFaults,
                     [](Trouble& trouble) {
                       trouble.new_runs = true;
                       trouble.power_cut = 0.01;
                     })},
    {"Operator", with(kFaults,
                      [](Trouble& trouble) {
                        trouble.operator_acts = true;
                        trouble.power_cut = 0.02;
                        trouble.review = Review::Duplicates;
                      })},
    {"StandingClocks", with(kFaults,
                            [](Trouble& trouble) {
                              trouble.clocks = CommandPost::Clocks::Standing;
                              trouble.power_cut = 0.01;
                            })},
    {"DifferingClocks", with(kFaults,
                             [](Trouble& trouble) {
                               trouble.clocks = CommandPost::Clocks::Differing;
                               trouble.new_runs = true;
                               trouble.power_cut = 0.01;
                             })},
    {"NewRunsOfOneName", with(kFaults,
                              [](Trouble& trouble) {
                                trouble.new_runs = trouble.one_name = true;
                                trouble.power_cut = 0.01;
                              })},
    {"Courses", with(kFaults,
                     [](Trouble& trouble) {
                       trouble.courses = true;
                       trouble.power_cut = 0.01;
                     })},
    {"CoursesOfStandingClocks", with(kFaults,
                                     [](Trouble& trouble) {
                                       trouble.courses = true;
                                       trouble.clocks = CommandPost::Clocks::Standing;
                                       trouble.disk_full = 0.1;
                                     })},
    {"Everything", with(kFaults,
                        [](Trouble& trouble) {
                          trouble.power_cut = 0.02;
                          trouble.disk_full = 0.1;
                          trouble.other_sender = trouble.admin_stops = trouble.new_runs = true;
                          trouble.operator_acts = true;
                        })},
};

/// Steps for each profile.
std::int64_t steps_wanted() {
  const char* const text = std::getenv("ADIT_MODEL_STEPS");
  return text != nullptr ? std::atoll(text) : 40'000;
}

std::uint64_t first_seed() {
  const char* const text = std::getenv("ADIT_MODEL_SEED");
  return text != nullptr ? std::strtoull(text, nullptr, 10) : 1;
}

class ReportsModel : public testing::TestWithParam<Profile> {};

TEST_P(ReportsModel, LosesNoReportAndRecordsNoneTwice) {
  Tally all;
  for (std::uint64_t seed = first_seed(); all.steps < steps_wanted(); ++seed) {
    World world(GetParam().trouble, seed);
    world.live();
    const auto broken = world.broken_promises();
    for (const std::string& sentence : broken) ADD_FAILURE() << "seed " << seed << ": " << sentence;
    if (!broken.empty()) {
      std::cout << world.story();
      return;
    }
    const Tally& one = world.tally();
    all.steps += one.steps;
    all.posts += one.posts;
    all.acknowledged += one.acknowledged;
    all.recorded += one.recorded;
    all.settled += one.settled;
    all.sent_again += one.sent_again;
    all.power_cuts += one.power_cuts;
    all.undecided += one.undecided;
    all.held += one.held;
    all.held_back += one.held_back;
    all.switches += one.switches;
  }
  std::cout << all.steps << " steps: " << all.posts << " posts, " << all.recorded << " recorded, "
            << all.acknowledged << " acknowledged, " << all.settled << " found recorded, " << all.sent_again
            << " found missing, " << all.power_cuts << " power cuts, " << all.undecided << " left in doubt, "
            << all.held << " held, " << all.held_back << " times by the operator, " << all.switches
            << " switches of course\n";
  EXPECT_GT(all.recorded, 0);
  if (GetParam().trouble.courses) {
    EXPECT_GT(all.switches, 0);
  }
  if (GetParam().trouble.operator_acts) {
    EXPECT_GT(all.held_back, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Trouble, ReportsModel, testing::ValuesIn(kProfiles),
                         [](const auto& profile) { return profile.param.name; });

}  // namespace
}  // namespace adit::dispatch::model
