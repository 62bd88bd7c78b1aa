#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/run_adit.hpp"

namespace adit::cli {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::string kSides =
    R"("team":{"interface":"team0","mode":"static","address":"192.168.7.11","prefix":24},)"
    R"("command_post":{"interface":"darpa0","addresses":[],"gateway":""})";

std::string view(const std::string& pending, const std::string& last, bool managed = true) {
  return Server::ok(std::string(R"({"now":1000,"managed":)") + (managed ? "true" : "false") +
                    R"(,"why":"it is set elsewhere","runs_here":true,)" + kSides + R"(,"pending":)" +
                    pending + R"(,"ports":[],"last":)" + last + R"(,"last_why":"nobody confirmed it"})");
}

const std::string kPending =
    R"({"until":1042,"team":{"mode":"static","address":"192.168.8.11","prefix":24},"command_post":{"addresses":)"
    R"([{"address":"10.100.1.10","prefix":24},{"address":"10.100.2.10","prefix":24}],"gateway":"10.100.1.1"},"previous":null,"page":"http://192.168.8.11:8000"})";

TEST(NetworkCommand, ShowsBothSides) {
  const Server server({{"GET /adit/network", view("null", "null")}});
  const Outcome outcome = run_adit(server, {"network"});
  EXPECT_EQ(outcome.exit, Exit::Fine);
  EXPECT_EQ(outcome.out, "  team          team0  static  192.168.7.11/24\n  command post  darpa0  none\n");
  EXPECT_EQ(run_adit(server, {"network", "show"}).out, outcome.out);
  EXPECT_THAT(run_adit(server, {"network", "--json"}).out, HasSubstr("\"managed\":true"));
}

TEST(NetworkCommand, ChangesTheNamedAddressesOnly) {
  const Server server(
      {{"GET /adit/network", view("null", "null")}, {"POST /adit/network", view(kPending, "null")}});
  const Outcome outcome = run_adit(
      server, {"network", "set", "team=192.168.8.11/24", "command_post=10.100.1.10/24,10.100.2.10/24"});
  EXPECT_THAT(outcome.out, HasSubstr("Confirm it at http://192.168.8.11:8000 (adit network confirm)"));
  EXPECT_THAT(
      server.posted(),
      testing::EndsWith(
          R"({"team":{"mode":"static","address":"192.168.8.11","prefix":24},"command_post":{"addresses":)"
          R"([{"address":"10.100.1.10","prefix":24},{"address":"10.100.2.10","prefix":24}],"gateway":""}})"));
  run_adit(server, {"network", "set", "team=dhcp"});
  EXPECT_THAT(server.posted(), HasSubstr(R"({"team":{"mode":"dhcp"},"command_post":{"addresses":[])"));
}

TEST(NetworkCommand, NamesAWrongAddress) {
  const Server server({{"GET /adit/network", view("null", "null")}});
  const auto error_of = [&server](const char* word) {
    return run_adit(server, {"network", "set", word}).err;
  };
  EXPECT_THAT(error_of("team=192.168.8.11"), HasSubstr("team=: expected an address as 192.168.8.11/24"));
  EXPECT_THAT(error_of("gateway=here"), HasSubstr("gateway=: expected an IPv4 address"));
  EXPECT_THAT(error_of("command_post=10.0.0.1"), HasSubstr("command_post=: expected addresses"));
  EXPECT_THAT(error_of("robots=10.0.0.1"), HasSubstr("expected team=, command_post= or gateway="));
  EXPECT_EQ(server.posted(), "");
}

TEST(NetworkCommand, ShowsTheAddressModeOfTheTeamSide) {
  const auto with = [](const char* team) {
    return Server::ok(
        std::string(R"({"now":1000,"managed":true,"why":"","runs_here":true,"team":)") + team +
        R"(,"command_post":{"interface":"darpa0","addresses":[],"gateway":""},"pending":null,"ports":[],)"
        R"("last":null,"last_why":""})");
  };
  const Server given({{"GET /adit/network",
                       with(R"({"interface":"team0","mode":"dhcp","address":"10.0.0.77","prefix":8})")}});
  EXPECT_THAT(run_adit(given, {"network"}).out, HasSubstr("team0  dhcp  10.0.0.77/8\n"));
  const Server none({{"GET /adit/network",
                      with(R"({"interface":"team0","mode":"link-local","address":null,"prefix":null})")}});
  EXPECT_THAT(run_adit(none, {"network"}).out, HasSubstr("team0  link-local  none\n"));
}

TEST(NetworkCommand, ShowsAPendingChange) {
  const Server server({{"GET /adit/network", view(kPending, "null")}});
  const Outcome outcome = run_adit(server, {"network", "show"});
  EXPECT_EQ(outcome.exit, Exit::Attention);
  EXPECT_THAT(outcome.out, HasSubstr("A change is to be confirmed within 42 s"));
  EXPECT_THAT(outcome.out, HasSubstr("static  192.168.8.11/24"));
  EXPECT_THAT(outcome.out, HasSubstr("10.100.1.10/24, 10.100.2.10/24  gateway 10.100.1.1"));
  EXPECT_THAT(outcome.out, HasSubstr("Confirm it at http://192.168.8.11:8000"));
}

TEST(NetworkCommand, RejectsAChangeWithoutAddresses) {
  const Server server(
      {{"GET /adit/network", view(R"({"until":1042,"previous":null,"page":"http://a"})", "null")}});
  const Outcome outcome = run_adit(server, {"network"});
  EXPECT_EQ(outcome.exit, Exit::Unable);
  EXPECT_EQ(outcome.out, "");
  EXPECT_THAT(outcome.err, HasSubstr("it is another version: pending.team: "));
}

TEST(NetworkCommand, ShowsTheLastChangeAndWhyNoneIsPossible) {
  const Server server({{"GET /adit/network", view("null", "\"reverted\"", false)}});
  const Outcome outcome = run_adit(server, {"network"});
  EXPECT_THAT(outcome.out, HasSubstr("Last change: reverted, nobody confirmed it\n"));
  EXPECT_THAT(outcome.out, HasSubstr("Adit cannot change the addresses: it is set elsewhere\n"));
}

TEST(NetworkCommand, ConfirmsOrRevertsAndShowsTheOutcome) {
  const Server server({{"POST /adit/network/confirm", view(kPending, "null")},
                       {"POST /adit/network/revert", view(kPending, "null")},
                       {"GET /adit/network", view("null", "\"confirmed\"")}});
  const Outcome confirmed = run_adit(server, {"network", "confirm"});
  EXPECT_EQ(confirmed.exit, Exit::Fine) << confirmed.err;
  EXPECT_EQ(confirmed.out, "the change is confirmed\n");
  const Outcome reverted = run_adit(server, {"network", "revert"});
  EXPECT_EQ(reverted.exit, Exit::Attention) << "the change was confirmed meanwhile";
  EXPECT_EQ(reverted.out, "the change is confirmed: nobody confirmed it\n");
}

TEST(NetworkCommand, TellsWhyAnActionFails) {
  const Server server(
      {{"POST /adit/network/confirm", Server::reply("409 Conflict", "\"no change waits to be confirmed\"")}});
  const Outcome outcome = run_adit(server, {"network", "confirm"});
  EXPECT_EQ(outcome.exit, Exit::Attention);
  EXPECT_EQ(outcome.err, "adit: no change waits to be confirmed\n");
  EXPECT_EQ(run_adit(Server("nonsense"), {"network"}).exit, Exit::Unable);
  EXPECT_THAT(run_adit(Server(Server::ok("{}")), {"network"}).err, HasSubstr("it is another version"));
}

TEST(NetworkCommand, RejectsUnknownWords) {
  EXPECT_THAT(run(std::vector<std::string_view>{"network", "apply"}).err,
              HasSubstr("expected show, set, confirm or revert, got apply"));
  EXPECT_THAT(run(std::vector<std::string_view>{"network", "show", "all"}).err,
              HasSubstr("one word too many: all"));
  EXPECT_THAT(run(std::vector<std::string_view>{"test", "all"}).err, HasSubstr("one word too many: all"));
  EXPECT_THAT(run(std::vector<std::string_view>{"help", "network"}).out, HasSubstr("adit network - "));
  EXPECT_THAT(run(std::vector<std::string_view>{"test", "--help"}).out, HasSubstr("adit test - "));
}

std::string tested(const std::string& clock, bool running = false,
                   const std::string& of = R"("applied":true,"outdated":false)") {
  return Server::ok(std::string(R"({"number":1,"running":)") + (running ? "true" : "false") + "," + of +
                    R"(,"course":"","endpoints":[{"name":"scoring","address":"10.100.1.200:8000","steps":[)"
                    R"({"name":"link","state":"good","said":"darpa0 has a carrier","advice":""},)"
                    R"({"name":"clock","state":")" +
                    clock + R"(","said":"7 s behind","advice":"Set it."}]}]})");
}

TEST(NetworkCommand, PrintsTestStepsAndFailsIfOneIsBad) {
  const Server server({{"POST /adit/test", tested("running", true)}, {"GET /adit/test", tested("bad")}});
  const Outcome outcome = run_adit(server, {"test"});
  EXPECT_EQ(outcome.exit, Exit::Attention) << outcome.err;
  EXPECT_EQ(outcome.out,
            "scoring 10.100.1.200:8000\n"
            "  link     good     darpa0 has a carrier\n"
            "  clock    BAD      7 s behind\n"
            "           Set it.\n");
  EXPECT_THAT(run_adit(server, {"test", "--json"}).out, HasSubstr("\"running\":false"));
}

TEST(NetworkCommand, TellsThatATestWasInterrupted) {
  constexpr const char* kKnowsOfNone =
      R"({"number":0,"running":false,"applied":true,"outdated":false,"course":"","endpoints":[]})";
  for (const std::string& left : {Server::ok(kKnowsOfNone), tested("waiting")}) {
    const Outcome outcome =
        run_adit(Server({{"POST /adit/test", tested("running", true)}, {"GET /adit/test", left}}), {"test"});
    EXPECT_EQ(outcome.exit, Exit::Unable);
    EXPECT_EQ(outcome.err, "adit: the test was interrupted, perhaps by a restart of Adit: start it again\n");
  }
}

TEST(NetworkCommand, JoinsARunningTest) {
  const Server server({{"POST /adit/test", Server::reply("409 Conflict", "\"a test is running\"")},
                       {"GET /adit/test", tested("skipped")}});
  const Outcome outcome = run_adit(server, {"test"});
  EXPECT_EQ(outcome.exit, Exit::Fine);
  EXPECT_THAT(outcome.out, testing::AllOf(HasSubstr("skipped"), Not(HasSubstr("bad"))));
  EXPECT_EQ(run_adit(Server(Server::reply("401 Unauthorized", "\"no\"")), {"test"}).exit, Exit::Unable);
  EXPECT_EQ(run_adit(Server(Server::reply("503 Service Unavailable", "\"no\"")), {"test"}).exit,
            Exit::Unable);
}

TEST(NetworkCommand, RejectsResultsOfOtherValues) {
  const auto test = [](const std::string& of) {
    return run_adit(
        Server({{"POST /adit/test", tested("running", true)}, {"GET /adit/test", tested("good", false, of)}}),
        {"test"});
  };
  const Outcome outdated = test(R"("applied":true,"outdated":true)");
  EXPECT_EQ(outdated.exit, Exit::Unable);
  EXPECT_EQ(outdated.err, "adit: the settings changed during the test: start it again\n");
  const Outcome tried = test(R"("applied":false,"outdated":false)");
  EXPECT_EQ(tried.exit, Exit::Unable);
  EXPECT_EQ(tried.err, "adit: a test of other values is running: try again when it has ended\n");
}

TEST(NetworkCommand, TestsTheNamedEndpointBeforeItIsApplied) {
  const TokenFile typed("typed-token-1");
  const std::string file = typed.path();
  // A running test is another one, so it is not joined.
  const Server busy(Server::reply("409 Conflict", "\"a test is running\""));
  const Outcome outcome =
      run_adit(busy, {"test", "--scoring", "10.100.2.200:8000", "--scoring-token", file, "--course", "B"});
  EXPECT_EQ(outcome.exit, Exit::Attention);
  EXPECT_EQ(outcome.err, "adit: a test is running\n");
  EXPECT_THAT(busy.request(),
              HasSubstr(R"("scoring":{"address":"10.100.2.200","port":8000,"token":"typed-token-1"})"));
  EXPECT_THAT(busy.request(), HasSubstr(R"("mapping":null,"course":"B")"));
  EXPECT_THAT(outcome.err + outcome.out, Not(HasSubstr("typed-token-1")));
  EXPECT_EQ(run_adit(Server(Server::reply("422 Unprocessable Content", "\"course: none is called B\"")),
                     {"test", "--mapping", "10.100.2.201:8000"})
                .exit,
            Exit::Attention);
  const Outcome none = run_adit(busy, {"test", "--mapping-token", "/no/such/file"});
  EXPECT_EQ(none.exit, Exit::Unable);
  EXPECT_THAT(none.err, HasSubstr("/no/such/file"));
  EXPECT_EQ(run_adit(busy, {"test", "--scoring", "10.100.2"}).exit, Exit::Unable);
  EXPECT_THAT(run_adit(busy, {"status", "--scoring", "10.100.2.200:8000"}).err,
              HasSubstr("status does not take --scoring"));
}

}  // namespace
}  // namespace adit::cli
