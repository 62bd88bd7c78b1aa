#include "archive/plot.hpp"

#include <gmock/gmock.h>

namespace adit::archive {
namespace {

using testing::HasSubstr;
using testing::Not;

/// The axes of 100 x 60 mm: 82 mm across from 14, 45 mm high from 51.
Plot plot(std::vector<double> minutes, std::vector<std::optional<double>> values) {
  return {.name = "Sent (Mbit/s)", .minutes = std::move(minutes), .values = std::move(values), .width = 100};
}

TEST(Plot, HasAxesWithTicksInUnits) {
  const std::string svg = draw_plot(plot({0, 30, 60}, {0, 50, 100}));
  for (const char* part : {">Sent (Mbit/s)</text>", ">minutes of the run</text>", ">0</text>", ">20</text>",
                           ">60</text>", ">80</text>", ">100</text>", "M14.00 51.00L55.00 "})
    EXPECT_THAT(svg, HasSubstr(part));
}

TEST(Plot, LeavesAGapForUnknownValues) {
  const std::string svg = draw_plot(plot({0, 20, 40, 60}, {1, {}, 1, 1}));
  const auto curve = svg.substr(svg.rfind("d=\""));
  EXPECT_EQ(std::ranges::count(curve, 'M'), 2) << curve;
}

TEST(Plot, HoldsAValueUntilTheNextOrTheEnd) {
  Plot held = plot({0, 30, 60}, {0, 100, 100});
  held.is_held = true;
  EXPECT_THAT(draw_plot(held), HasSubstr("M14.00 51.00L55.00 51.00L55.00 "));
}

TEST(Plot, KeepsPeaksOfManyValues) {
  std::vector<double> minutes;
  std::vector<std::optional<double>> values;
  for (int i = 0; i < 20'000; ++i) {
    minutes.push_back(i * 0.003);
    values.emplace_back(i == 7003 ? 100 : 1);
  }
  const std::string peak = draw_plot(plot(minutes, values));
  EXPECT_LT(peak.size(), 30'000);
  values[7003] = 1;
  EXPECT_NE(peak.substr(peak.rfind("d=\"")), draw_plot(plot(minutes, values)).substr(peak.rfind("d=\"")));
  EXPECT_THAT(peak, HasSubstr(">100</text>"));
}

TEST(Plot, IsOmittedWithoutValues) {
  EXPECT_EQ(draw_plot(plot({}, {})), "");
  EXPECT_EQ(draw_plot(plot({0, 1}, {{}, {}})), "");
  EXPECT_THAT(draw_plot(plot({5}, {0})), Not(HasSubstr("nan")));
}

}  // namespace
}  // namespace adit::archive
