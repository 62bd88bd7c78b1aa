#include <gmock/gmock.h>

#include "api/updates.hpp"
#include "cli/run_adit.hpp"

namespace adit::cli {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

constexpr const char* kWhy = "slot A with 0.1.0 runs, and slot B with 0.2.0 was good last";

api::UpdateView a_box(const std::string& stray) {
  api::UpdateView view;
  view.managed = true;
  view.status.running = {"adit-a-board", "0.1.0", "A", "B"};
  view.status.stray = stray;
  return view;
}

Outcome run_update(const Server& server, std::vector<std::string_view> words) {
  words.insert(words.begin(), "update");
  return run_adit(server, words);
}

TEST(Update, ShowsTheRunningSlot) {
  const Server server({{"GET /adit/update", Server::ok(codec::to_json(a_box("")))}});
  const Outcome outcome = run_update(server, {});
  EXPECT_EQ(outcome.out, "0.1.0 runs, in slot A (an update goes into slot B) of adit-a-board\n");
  EXPECT_EQ(outcome.exit, Exit::Fine);
}

TEST(Update, ShowsAnUnexpectedSlotAndBothChoices) {
  const Server server({{"GET /adit/update", Server::ok(codec::to_json(a_box(kWhy)))}});
  const Outcome outcome = run_update(server, {});
  EXPECT_THAT(outcome.out, HasSubstr("An unexpected slot runs: " + std::string(kWhy)));
  EXPECT_THAT(outcome.out, HasSubstr("adit update --back "));
  EXPECT_THAT(outcome.out, HasSubstr("adit update --stay "));
  EXPECT_EQ(outcome.exit, Exit::Attention);
}

TEST(Update, OnAPcRefersToApt) {
  api::UpdateView pc;
  pc.why = "adit-update does not run here";
  const auto said_of = [&pc] {
    return run_update(Server({{"GET /adit/update", Server::ok(codec::to_json(pc))}}), {});
  };
  EXPECT_EQ(said_of().out, "This box cannot be updated: adit-update does not run here\n");
  pc.newer_why = "no permission";
  EXPECT_THAT(said_of().out, EndsWith("The newer version of apt is not known: no permission\n"));
  EXPECT_EQ(said_of().exit, Exit::Attention);
  pc.newer_why = "";
  pc.newer = "";
  EXPECT_EQ(said_of().out, "apt has no newer version\n");
  pc.newer = "0.2.0";
  EXPECT_EQ(said_of().out, "apt has 0.2.0: apt upgrade\n");
  EXPECT_EQ(said_of().exit, Exit::Fine);
}

TEST(Update, GoesBackOrStaysOnRequest) {
  const std::string after = Server::ok(codec::to_json(a_box("")));
  const Server server({{"POST /adit/update/back", after}, {"POST /adit/update/stay", after}});
  EXPECT_EQ(run_update(server, {"--back"}).out, "the box restarts into the slot that was good last\n");
  EXPECT_THAT(server.request(), EndsWith("\r\n\r\n{}"));
  run_update(server, {"--back", "--anyway"});
  EXPECT_THAT(server.request(), EndsWith("\r\n\r\n{\"anyway\": true}"));
  EXPECT_EQ(run_update(server, {"--stay"}).out, "the box keeps the slot that runs\n");
  const Server none(
      {{"POST /adit/update/stay", Server::reply("409 Conflict", "\"no unexpected slot is running\"")}});
  const Outcome refused = run_update(none, {"--stay"});
  EXPECT_EQ(refused.err, "adit: no unexpected slot is running\n");
  EXPECT_EQ(refused.exit, Exit::Attention);
}

TEST(Update, DoesOneThingAtATime) {
  const Server server(Server::Answers{});
  for (const char* other : {"--restart", "--stick", "--stay", "a.raucb"})
    EXPECT_THAT(run_update(server, {"--back", other}).err, HasSubstr("give only one of FILE, --stick"))
        << other;
  EXPECT_THAT(run_update(server, {"--stay", "--anyway"}).err, HasSubstr("update does not take --anyway"));
}

}  // namespace
}  // namespace adit::cli
