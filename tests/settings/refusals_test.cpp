// Rooms that do not know the settings name a setting's key in a rejection.
#include <gmock/gmock.h>

#include "codec/body_decoder.hpp"
#include "codec/members.hpp"
#include "codec/read.hpp"
#include "icd/rules.hpp"
#include "settings/keys.hpp"

namespace adit::settings {
namespace {

using codec::Reading;
using testing::Contains;
using testing::Field;

std::string_view setting_of(const icd::Checked<void>& checked) {
  return checked ? "" : checked.error().setting;
}

std::string_view setting_of_name(std::string name) {
  const codec::Value value{std::move(name)};
  Reading reading;
  const codec::Field field(value, reading);
  const auto read = reading.outcome(codec::read_robot_name(field, {}));
  return read ? "" : read.error().setting;
}

std::string_view setting_of_type(std::string_view type) {
  const auto document = codec::decode({}, codec::Split::Nothing,
                                      icd::sentence(R"({"x":1,"y":2,"z":3,"type":")", type, R"("})"));
  const auto read = codec::read_artifact_report(*document, {});
  return read ? "" : read.error().setting;
}

TEST(Refusals, NameASettingByItsKey) {
  icd::OccupancyGrid grid;
  grid.resolution = 1, grid.width = 3, grid.height = 1;
  icd::Rules rules;
  rules.map_bytes = 2;
  for (const auto& [setting, key] :
       {std::pair(setting_of(icd::check(grid, rules)), "rules.map_bytes"),
        {setting_of(icd::check_frame_id("map", "f", rules)), "rules.rewrite_frame_id"},
        {setting_of_type("test"), "rules.forward_unknown_types"},
        {setting_of_name("not-a-name"), "robots[].alias"}}) {
    EXPECT_EQ(setting, key);
    EXPECT_THAT(keys(), Contains(Field(&Key::path, setting)));
  }
  for (const std::string_view key : {"team.origins", "queues.marker_bytes"})  // of intake and forward
    EXPECT_THAT(keys(), Contains(Field(&Key::path, key)));
  EXPECT_EQ(setting_of_name(""), "") << "an empty name cannot have an alias";
}

}  // namespace
}  // namespace adit::settings
