#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "api/box_routes.hpp"
#include "api/on_page.hpp"
#include "intake/raw_client.hpp"
#include "intake/served.hpp"

namespace adit::api {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string kNumbers =
    R"({"team":{"mode":"static","address":"192.168.8.11","prefix":24},)"
    R"("command_post":{"addresses":[{"address":"10.100.1.10","prefix":24}],"gateway":"10.100.1.1"}})";
const network::Numbers kRead = {
    .team = {0xc0a8080b, 24}, .command_post = {{0x0a64010a, 24}}, .gateway = 0x0a640101};

class NetworkRoutesTest : public OnPage {};

TEST_F(NetworkRoutesTest, ShowTheInterfaces) {
  network.view = {
      .now = 1000,
      .managed = true,
      .why = "",
      .team_interface = "team0",
      .command_post_interface = "darpa0",
      .team = settings::Subnet{0xc0a8070b, 24},
      .command_post = {},
      .mode = network::Mode::Dhcp,
      .gateway = {},
      .pending = {},
      .ports = {{"team", "team0", "02:00:00:00:00:01", {"192.168.7.11/24"}, "adit.local", true, 1000, "full"},
                {"command_post", "darpa0", "", {}, "", std::nullopt, std::nullopt, ""}},
      .last = "",
      .last_why = ""};
  EXPECT_EQ(json::parse(get("/adit/network").body), json::parse(R"({
    "now": 1000, "managed": true, "why": "", "runs_here": false, "team": {"interface": "team0", "mode": "dhcp", "address": "192.168.7.11", "prefix": 24},
    "command_post": {"interface": "darpa0", "addresses": [], "gateway": ""},
    "pending": null,
    "ports": [{"side": "team", "interface": "team0", "mac": "02:00:00:00:00:01", "addresses": ["192.168.7.11/24"],
               "name": "adit.local", "carrier": true, "mbit": 1000, "duplex": "full"},
              {"side": "command_post", "interface": "darpa0", "mac": "", "addresses": [], "name": "", "carrier": null,
               "mbit": null, "duplex": ""}],
    "last": null, "last_why": ""})"));
}

TEST_F(NetworkRoutesTest, ShowEachAddressOfTheCommandPostSide) {
  network.view.command_post = {{0x0a64010a, 24}, {0x0a64020a, 16}};
  network.view.gateway = 0x0a640101;
  const json shown = json::parse(get("/adit/network").body);
  EXPECT_EQ(shown["command_post"]["addresses"],
            json::parse(R"([{"address":"10.100.1.10","prefix":24},{"address":"10.100.2.10","prefix":16}])"));
  EXPECT_EQ(shown["command_post"]["gateway"], "10.100.1.1");
  EXPECT_EQ(shown["team"]["mode"], "static");
  EXPECT_TRUE(shown["team"]["address"].is_null());
}

TEST_F(NetworkRoutesTest, AcceptTheOldFormOfASingleAddress) {
  post("/adit/network", R"({"team":{"address":"192.168.8.11","prefix":24},)"
                        R"("command_post":{"address":"10.100.1.10","prefix":24,"gateway":"10.100.1.1"}})");
  EXPECT_THAT(network.wanted, ElementsAre(kRead));
}

TEST_F(NetworkRoutesTest, ShowAPendingChange) {
  network.view.pending = PendingNetwork{1234.5, kRead, std::nullopt, "http://192.168.8.11:8000"};
  network.view.last = "reverted";
  network.view.last_why = "the change was not confirmed within 90 s";
  const json shown = json::parse(get("/adit/network").body);
  EXPECT_EQ(shown["pending"]["until"], 1234.5);
  EXPECT_EQ(shown["pending"]["team"]["address"], "192.168.8.11");
  EXPECT_EQ(shown["pending"]["command_post"]["gateway"], "10.100.1.1");
  EXPECT_TRUE(shown["pending"]["previous"].is_null());
  EXPECT_EQ(shown["pending"]["page"], "http://192.168.8.11:8000");
  EXPECT_EQ(shown["last"], "reverted");
  network.view.pending->previous = kRead;
  EXPECT_EQ(json::parse(get("/adit/network").body)["pending"]["previous"]["team"]["prefix"], 24);
}

TEST_F(NetworkRoutesTest, CheckWithoutChangingAnything) {
  network.findings = {{{"team.address", "overlaps"}}, {{"team.address", "a", "b"}}, {"this cuts you off"}};
  EXPECT_EQ(json::parse(post("/adit/network/check", kNumbers).body), json::parse(R"({
    "errors": [{"path": "team.address", "what": "overlaps"}],
    "changes": [{"path": "team.address", "from": "a", "to": "b"}], "warnings": ["this cuts you off"]})"));
  EXPECT_THAT(network.askers, ElementsAre("10.0.0.5"));
  EXPECT_THAT(network.wanted, IsEmpty());
  const json wrong = json::parse(post("/adit/network/check", R"({"team":{},"command_post":7})").body);
  EXPECT_EQ(wrong["errors"].size(), 3u);
  EXPECT_EQ(wrong["errors"][0]["path"], "team.address");
  EXPECT_EQ(json::parse(post("/adit/network/check", "{").body)["errors"][0]["path"], "");
}

TEST_F(NetworkRoutesTest, ApplyAChangeThatPassesTheCheck) {
  EXPECT_EQ(post("/adit/network", kNumbers).status, icd::Status::Ok);
  EXPECT_THAT(network.wanted, ElementsAre(kRead));
  network.findings.errors = {{"team.address", "overlaps"}, {"team.prefix", "no"}};
  const auto answer = post("/adit/network", kNumbers);
  EXPECT_EQ(answer.status, icd::Status::UnprocessableEntity);
  EXPECT_EQ(json::parse(answer.body), "team.address: overlaps; team.prefix: no");
  EXPECT_EQ(post("/adit/network", "{}").status, icd::Status::UnprocessableEntity);
  EXPECT_EQ(post("/adit/network", "no").status, icd::Status::UnprocessableEntity);
  network.findings.errors.clear();
  network.outcome = std::unexpected(icd::Refusal{icd::Status::Conflict, "a change waits"});
  EXPECT_EQ(post("/adit/network", kNumbers).status, icd::Status::Conflict);
}

TEST_F(NetworkRoutesTest, ConfirmByTheAddressOfTheRequest) {
  local = "192.168.8.11";
  post("/adit/network/confirm");
  EXPECT_THAT(network.confirmed, ElementsAre("192.168.8.11"));
  post("/adit/network/revert");
  EXPECT_EQ(network.reverted, 1);
  network.outcome = std::unexpected(icd::Refusal{icd::Status::Conflict, "there is no change to confirm"});
  const auto answer = post("/adit/network/confirm");
  EXPECT_EQ(answer.status, icd::Status::Conflict);
  EXPECT_EQ(json::parse(answer.body), "there is no change to confirm");
}

TEST_F(NetworkRoutesTest, RunOneTestAtATime) {
  EXPECT_EQ(get("/adit/test").body,
            R"({"number":0,"running":false,"applied":true,"outdated":false,"course":"","endpoints":[]})");
  test.view.endpoints = {{"scoring", "10.100.1.200:8000", {{"link", "bad", "no carrier", "plug it in"}}}};
  const json begun = json::parse(post("/adit/test").body);
  EXPECT_EQ(begun["running"], true);
  EXPECT_EQ(begun["endpoints"][0]["steps"][0],
            json::parse(R"({"name":"link","state":"bad","said":"no carrier","advice":"plug it in"})"));
  EXPECT_TRUE(test.tried.is_applied());
  EXPECT_EQ(post("/adit/test").status, icd::Status::Conflict);
}

TEST_F(NetworkRoutesTest, TestTheNamedEndpointBeforeItIsApplied) {
  post("/adit/test", R"({"course":"B","scoring":{"address":"10.100.2.200","port":8001,"token":"typed-1"},)"
                     R"("mapping":{"port":9000,"token":null}})");
  ASSERT_TRUE(test.tried.scoring && test.tried.mapping);
  EXPECT_EQ(test.tried.course, "B");
  EXPECT_EQ(test.tried.scoring->address, "10.100.2.200");
  EXPECT_EQ(test.tried.scoring->port, 8001);
  EXPECT_EQ(test.tried.scoring->token->reveal(), "typed-1");
  EXPECT_EQ(test.tried.mapping->address, std::nullopt);
  EXPECT_EQ(test.tried.mapping->port, 9000);
  EXPECT_FALSE(test.tried.mapping->token);
  test.view.running = false;
  post("/adit/test", R"({"course":""})");
  EXPECT_EQ(test.tried.course, "");
  EXPECT_FALSE(test.tried.scoring || test.tried.mapping);
  EXPECT_FALSE(test.tried.is_applied());
}

TEST_F(NetworkRoutesTest, RejectAMalformedTest) {
  const auto refusal = [this](const char* body, icd::Status status = icd::Status::UnprocessableEntity) {
    const auto answer = post("/adit/test", body);
    EXPECT_EQ(answer.status, status) << body;
    return answer.body;
  };
  EXPECT_THAT(refusal(R"({"scorign":{}})"), HasSubstr("no such member"));
  EXPECT_THAT(refusal(R"({"scoring":{"host":"10.0.0.1"}})"), HasSubstr("scoring: no such member"));
  EXPECT_THAT(refusal(R"({"scoring":{"port":0}})"),
              HasSubstr("scoring.port: expected a whole number from 1 to 65535"));
  EXPECT_THAT(refusal(R"({"mapping":"10.0.0.1"})"), HasSubstr("mapping: expected an object"));
  EXPECT_THAT(refusal(R"({"mapping":{"token":"two words, one secret"}})"), testing::Not(HasSubstr("secret")));
  EXPECT_THAT(refusal(R"([1])"), HasSubstr("expected an object"));
  refusal("{", icd::Status::BadRequest);
  EXPECT_FALSE(test.view.running);
  test.outcome =
      std::unexpected(icd::Refusal{icd::Status::UnprocessableEntity, "scoring.address: expected one"});
  EXPECT_EQ(refusal("{}"), "\"scoring.address: expected one\"");
}

TEST(NetworkRoutesOnAServer, SeeTheLocalAddressOfAConnection) {
  std::unique_ptr<Api> api;
  Forward forward;
  Doubles doubles;
  intake::Served served{forward};
  served.on_loop([&] {
    api = std::make_unique<Api>(served.loop(), doubles.served(), std::vector{token()});
    forward.to = api.get();
  });
  intake::RawClient client{served.port()};
  client.send(intake::request("POST", "/adit/network/confirm",
                              "Authorization: Bearer team-1\r\nContent-Type: application/json\r\n"));
  const auto reply = client.reply();
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->status, 200);
  served.on_loop([&] { forward.to = nullptr, api.reset(); });
  EXPECT_THAT(doubles.network.confirmed, ElementsAre("127.0.0.1"));
}

}  // namespace
}  // namespace adit::api
