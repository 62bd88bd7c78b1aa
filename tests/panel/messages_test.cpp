#include "panel/messages.hpp"

#include <gtest/gtest.h>

namespace adit::panel {
namespace {

std::string error_of(std::string_view text) {
  const auto parsed = parse_message(text);
  return parsed ? "" : parsed.error();
}

TEST(Messages, ReadBackTheSame) {
  const Lit lit{true, false, false, true};
  EXPECT_EQ(message_of(LightRequest{lit}), "lit 1001");
  const auto light = parse_message("lit 1001");
  ASSERT_TRUE(light && std::holds_alternative<LightRequest>(*light));
  EXPECT_EQ(std::get<LightRequest>(*light).lit, lit);
  const auto end = parse_message(message_of(EndRequest{}));
  EXPECT_TRUE(end && std::holds_alternative<EndRequest>(*end));
}

TEST(Messages, CarryEachMemberOfAPanel) {
  settings::Panel panel;
  panel.chip = std::string("/dev/gpiochip1");
  panel.health = std::string("H");
  panel.scoring = std::string("S");
  panel.mapping = std::string("M");
  panel.attention = std::string("A");
  panel.button = std::string("B");
  panel.active_low = true;
  panel.button_active_low = false;
  const auto parsed = parse_message(message_of(LinesRequest{panel}));
  ASSERT_TRUE(parsed) << parsed.error();
  const settings::Panel& read = std::get<LinesRequest>(*parsed).panel;
  EXPECT_EQ(message_of(LinesRequest{read}), message_of(LinesRequest{panel}));
  EXPECT_EQ(read.chip, panel.chip);
  EXPECT_EQ(read.attention, panel.attention);
  EXPECT_EQ(read.button, panel.button);
  EXPECT_TRUE(read.active_low);
  EXPECT_FALSE(read.button_active_low);
}

TEST(Messages, CarryASimulatedPanel) {
  const auto parsed = parse_message(message_of(LinesRequest{}));
  ASSERT_TRUE(parsed) << parsed.error();
  EXPECT_TRUE(std::get<LinesRequest>(*parsed).panel.is_simulated());
}

/// The longest message that the settings allow. A chip name of 255 characters would be cut.
TEST(Messages, StayWithinTheirLimit) {
  settings::Panel panel;
  panel.chip = std::string(255, 'c');
  panel.health = panel.scoring = panel.mapping = panel.attention = panel.button = std::string(31, 'h');
  EXPECT_LE(message_of(LinesRequest{panel}).size(), kLongestMessage);
}

TEST(Messages, InvalidAreRejectedWithAReason) {
  for (const std::string_view text : {"", "lit", "lit1001", "END", "end ", "fault", "\xff\xfe", "button 1"}) {
    EXPECT_EQ(error_of(text), "unknown message") << text;
  }
  EXPECT_EQ(error_of("lit 100"), "lit: expected a digit for each light");
  EXPECT_EQ(error_of("lit 10011"), "lit: expected a digit for each light");
  EXPECT_EQ(error_of("lit 10x1"), "lit: expected 0 or 1 for each light");
  EXPECT_EQ(error_of("panel {"), "panel: not well-formed JSON at byte 1: the document is cut short");
  EXPECT_EQ(error_of(R"(panel {"name":"b","title":"B"})"), "panel: missing");
  EXPECT_NE(error_of(R"(panel {"name":"b","title":"B","panel":{"health":"a line"}})").find("panel.health"),
            std::string::npos);
  EXPECT_EQ(error_of("panel " + std::string(kLongestMessage, ' ')), "the message is too long");
}

TEST(Messages, OfTheOtherDirectionReadBackTheSame) {
  for (const std::string_view text :
       {"button 1", "button 0", "button gone", "lights 1", "lights 0 panel: line H: No such device"}) {
    const auto said = parse_report(text);
    ASSERT_TRUE(said) << text;
    EXPECT_EQ(std::visit([](const auto& each) { return message_of(each); }, *said), text);
  }
  EXPECT_EQ(parse_report("button gone"), PanelReport(ButtonState{std::nullopt}));
  EXPECT_EQ(parse_report("button 1"), PanelReport(ButtonState{true}));
  EXPECT_EQ(parse_report("lights 1"), PanelReport(LightsState{}));
}

TEST(Messages, OfTheOtherDirectionAreRejectedIfInvalid) {
  const std::string longest(LightsState::kLongest, 'x');
  EXPECT_TRUE(parse_report("lights 0 " + longest));
  for (const std::string& text :
       {std::string(), std::string("button"), std::string("button 2"), std::string("button 1 "),
        std::string("press"), std::string("lights"), std::string("lights 0"), std::string("lights 0 "),
        std::string("lights 1 x"), std::string("lights 0 a\nb"), std::string("lights 0 \xff"),
        "lights 0 " + longest + "x"}) {
    EXPECT_EQ(parse_report(text), std::nullopt) << text;
  }
}

TEST(Messages, TruncateALongTrouble) {
  EXPECT_EQ(message_of(LightsState{"a\tb\xff"}), "lights 0 a?b?");
  EXPECT_EQ(message_of(LightsState{std::string(5000, 'x')}),
            "lights 0 " + std::string(LightsState::kLongest, 'x'));
}

}  // namespace
}  // namespace adit::panel
