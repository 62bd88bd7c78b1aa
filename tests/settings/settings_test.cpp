#include "settings/settings.hpp"

#include <gtest/gtest.h>

#include "settings/sample.hpp"

namespace adit::settings {
namespace {

using std::chrono::milliseconds;

Settings parsed(const std::string& json) {
  auto settings = parse(json);
  if (!settings) {
    for (const Error& error : settings.error()) ADD_FAILURE() << error.sentence();
    return {};
  }
  return *settings;
}

TEST(Settings, NeedOnlyTheAddresses) {
  const Settings settings = parsed(sample());
  EXPECT_EQ(settings.command_post.scoring, (Address{"10.100.1.200", 8000}));
  EXPECT_EQ(settings.command_post.mapping, (Address{"10.100.1.201", 8001}));
  EXPECT_EQ(settings.team.listen, (std::vector<Address>{{"0.0.0.0", 8000}}));
  EXPECT_EQ(settings.command_post.interface, "");
  EXPECT_EQ(settings.command_post.budget_mbit, 100);
  EXPECT_EQ(settings.command_post.rates.map_hz, 1);
  EXPECT_EQ(settings.team.require_token, true);
  EXPECT_EQ(settings.panel.chip, "");
  EXPECT_TRUE(settings.panel.is_simulated());
  EXPECT_TRUE(settings.panel.button_active_low);
}

TEST(Settings, AcceptOriginsAsBrowsersWriteThem) {
  for (const char* const good : {"", "http://a", "https://a:8443",
                                 "http://station.local http://10.0.0.20:65535", "http://[fd00::1]:3000"}) {
    EXPECT_TRUE(parse(sample("", R"(, "origins": ")" + std::string(good) + R"(")"))) << good;
  }
  for (const char* const bad : {"null",
                                "*",
                                "a",
                                "http://",
                                "://a",
                                "http://a/",
                                "http://A",
                                "HTTP://a",
                                "http://a:",
                                "http://a:0",
                                "http://a:080",
                                "http://a:65536",
                                "http://a:80",
                                "https://a:443",
                                "http://a:x",
                                "http://*.a",
                                "http://u@a",
                                "http://[fd00::1",
                                "http://[a]",
                                "http://a,http://b",
                                "http://a\tb",
                                "http://a null"}) {
    EXPECT_FALSE(parse(sample("", R"(, "origins": ")" + std::string(bad) + R"(")"))) << bad;
  }
}

TEST(Settings, SetEachMemberByItsKey) {
  const Settings settings = parsed(R"({
    "version": 1,
    "command_post": {
      "scoring": {"address": "fd00::1", "port": 1}, "mapping": {"address": "::1", "port": 65535},
      "interface": "darpa0", "budget_mbit": 12.5,
      "rates": {"reports_hz": 2, "status_hz": 3, "map_hz": 0.5, "state_hz": 5, "markers_hz": 6},
      "timeouts": {"connect_ms": 101, "scoring_answer_ms": 102, "mapping_answer_ms": 103}},
    "team": {
      "listen": [{"address": "10.0.0.1", "port": 80}, {"address": "fd00::2", "port": 0}],
      "interface": "team0", "require_token": false,
      "origins": " http://10.0.0.20:3000  app://station ", "connections": 40, "connections_per_address": 4},
    "reports": {"answer_within_ms": 5000, "doubt_for_ms": 100, "doubt_asks": 100, "review": "duplicates",
                "near_metres": 0.5, "undo_s": 60},
    "queues": {"map_bytes": 2000000, "merge_bytes": 0, "marker_bytes": 3000000,
               "markers_per_message": 7, "marker_bytes_per_message": 8000},
    "rules": {"rewrite_frame_id": true, "forward_unknown_types": true, "map_bytes": 4096},
    "panel": {"chip": "/dev/gpiochip1", "health": "H", "scoring": "S", "mapping": "M", "attention": "A",
              "active_low": true, "button": "B", "button_active_low": false},
    "courses": [{"name": "A", "scoring": {"address": "::3", "port": 3}, "mapping": {"address": "::4", "port": 4}},
                {"name": "b-2", "scoring": {"address": "::5", "port": 5}, "mapping": {"address": "::6", "port": 6}}],
    "robots": [{"name": "ugv1", "alias": "husky/1"}, {"name": "ugv2"}],
    "network": {"confirm_within_ms": 5000, "allow_overlap": true}})");
  const CommandPost& post = settings.command_post;
  EXPECT_EQ(post.scoring, (Address{"fd00::1", 1}));
  EXPECT_EQ(post.mapping, (Address{"::1", 65535}));
  EXPECT_EQ(post.interface, "darpa0");
  EXPECT_EQ(post.budget_mbit, 12.5);
  EXPECT_EQ(post.rates.reports_hz, 2);
  EXPECT_EQ(post.rates.status_hz, 3);
  EXPECT_EQ(post.rates.map_hz, 0.5);
  EXPECT_EQ(post.rates.state_hz, 5);
  EXPECT_EQ(post.rates.markers_hz, 6);
  EXPECT_EQ(post.timeouts.connect, milliseconds(101));
  EXPECT_EQ(post.timeouts.scoring_answer, milliseconds(102));
  EXPECT_EQ(post.timeouts.mapping_answer, milliseconds(103));
  EXPECT_EQ(settings.team.listen, (std::vector<Address>{{"10.0.0.1", 80}, {"fd00::2", 0}}));
  EXPECT_EQ(settings.team.interface, "team0");
  EXPECT_FALSE(settings.team.require_token);
  EXPECT_EQ(words(settings.team.origins),
            (std::vector<std::string_view>{"http://10.0.0.20:3000", "app://station"}));
  EXPECT_EQ(settings.team.connections, 40u);
  EXPECT_EQ(settings.team.connections_per_address, 4u);
  EXPECT_EQ(settings.reports.answer_within, milliseconds(5000));
  EXPECT_EQ(settings.reports.doubt_for, milliseconds(100));
  EXPECT_EQ(settings.reports.doubt_asks, 100);
  EXPECT_EQ(settings.reports.review, dispatch::Review::Duplicates);
  EXPECT_EQ(settings.reports.near_metres, 0.5);
  EXPECT_EQ(settings.reports.undo, std::chrono::seconds(60));
  EXPECT_EQ(settings.queues.map_bytes, 2000000u);
  EXPECT_EQ(settings.queues.merge_bytes, 0u);
  EXPECT_EQ(settings.queues.marker_bytes, 3000000u);
  EXPECT_EQ(settings.queues.markers_per_message, 7u);
  EXPECT_EQ(settings.queues.marker_bytes_per_message, 8000u);
  EXPECT_TRUE(settings.rules.rewrite_frame_id);
  EXPECT_TRUE(settings.rules.forward_unknown_types);
  EXPECT_EQ(settings.rules.map_bytes, 4096u);
  EXPECT_EQ(settings.panel.chip, "/dev/gpiochip1");
  EXPECT_EQ(settings.panel.health, "H");
  EXPECT_EQ(settings.panel.scoring, "S");
  EXPECT_EQ(settings.panel.mapping, "M");
  EXPECT_EQ(settings.panel.attention, "A");
  EXPECT_TRUE(settings.panel.active_low);
  EXPECT_EQ(settings.panel.button, "B");
  EXPECT_FALSE(settings.panel.button_active_low);
  ASSERT_EQ(settings.courses.size(), 2u);
  EXPECT_EQ(settings.courses[0].name, "A");
  EXPECT_EQ(settings.courses[0].scoring, (Address{"::3", 3}));
  EXPECT_EQ(settings.courses[1].mapping, (Address{"::6", 6}));
  ASSERT_EQ(settings.robots.size(), 2u);
  EXPECT_EQ(settings.robots[0].name, "ugv1");
  EXPECT_EQ(settings.robots[0].alias, "husky/1");
  EXPECT_EQ(settings.robots[1].alias, "");
  const Network& network = settings.network;
  EXPECT_EQ(network.confirm_within, milliseconds(5000));
  EXPECT_TRUE(network.allow_overlap);
}

TEST(Settings, InUseHaveTheEndpointsOfTheCourseAndTheAliases) {
  const std::string rest =
      R"(, "courses": [{"name": "B", "scoring": {"address": "10.100.2.200", "port": 8000},)"
      R"( "mapping": {"address": "10.100.2.201", "port": 8000}}], "robots": [{"name": "ugv1", "alias": "husky"}])";
  const Settings none = effective_settings(parsed(sample("", "", rest)));
  EXPECT_EQ(none.command_post.scoring, (Address{"10.100.1.200", 8000}));
  const Settings with_course = effective_settings(parsed(sample(R"(, "course": "B")", "", rest)));
  EXPECT_EQ(with_course.command_post.scoring, (Address{"10.100.2.200", 8000}));
  EXPECT_EQ(with_course.command_post.mapping, (Address{"10.100.2.201", 8000}));
  EXPECT_EQ(with_course.rules.aliases.at("husky").text(), "ugv1");
}

TEST(Settings, AcceptAWholeNumberInEachForm) {
  for (const std::string number : {"40", "40.0", "4e1", "4.0E+1"}) {
    EXPECT_EQ(parsed(sample("", R"(, "connections": )" + number)).team.connections, 40u) << number;
  }
}

TEST(Settings, DefaultToTheReportRules) {
  const dispatch::ReportRules rules;
  const Reports reports = parsed(sample()).reports;
  EXPECT_EQ(reports.answer_within, rules.answer_within);
  EXPECT_EQ(reports.doubt_for, rules.policy.doubt_for);
  EXPECT_EQ(reports.doubt_asks, rules.policy.asks);
  EXPECT_EQ(reports.review, rules.review);
  EXPECT_EQ(reports.near_metres, rules.near_metres);
  EXPECT_EQ(reports.undo, rules.undo);
}

TEST(Settings, AcceptEachWordOfAChoice) {
  const auto review = [](const std::string& word) {
    return parsed(sample("", "", R"(, "reports": {"review": ")" + word + "\"}")).reports.review;
  };
  EXPECT_EQ(review("off"), dispatch::Review::Off);
  EXPECT_EQ(review("duplicates"), dispatch::Review::Duplicates);
  EXPECT_EQ(review("all"), dispatch::Review::All);
}

TEST(Settings, AcceptTheEndsOfEachRange) {
  EXPECT_EQ(parsed(sample(R"(, "rates": {"map_hz": 0.001})")).command_post.rates.map_hz, 0.001);
  EXPECT_EQ(parsed(sample(R"(, "rates": {"map_hz": 1000})")).command_post.rates.map_hz, 1000);
  EXPECT_EQ(parsed(sample(R"(, "interface": "exactly15chars_")")).command_post.interface, "exactly15chars_");
}

}  // namespace
}  // namespace adit::settings
