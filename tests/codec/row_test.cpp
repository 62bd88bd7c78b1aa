#include "codec/row.hpp"

#include <gmock/gmock.h>

#include "codec/json.hpp"
#include "codec/schemas.hpp"

namespace adit::codec {
namespace {

struct Rope {
  std::string colour;
  icd::Point end = {};

  static const Row kRow;
};

struct Climb {
  std::int64_t number = 0;
  Rope rope = {};
  std::string note = "";
  std::optional<double> height = std::nullopt;
  std::vector<std::uint64_t> steps = {};
  std::optional<icd::Point> top = std::nullopt;
  bool done = false;

  static const Row kRow;
};

constexpr std::string_view kColours[] = {"red", "blue"};
constexpr Member kRope[] = {member<&Rope::colour>("colour").one_of(kColours),
                            member<&Rope::end, &icd::Point::z>("z", "metres")};
constexpr Member kClimb[] = {member<&Climb::number>("number").from(1).to(9),
                             member<&Climb::rope>(""),
                             member<&Climb::note>("note").as(kTextOrNull),
                             member<&Climb::height>("height"),
                             member<&Climb::steps>("steps"),
                             member<&Climb::top>("top", "of the shaft"),
                             member<&Climb::done>("done")};
constexpr Row Rope::kRow = {"", kRope};
constexpr Row Climb::kRow = {"Climb", kClimb, "One way up."};

Climb climb() {
  return {.number = 3,
          .rope = {.colour = "red", .end = {.x = 0, .y = 0, .z = 1.5}},
          .steps = {1, 2},
          .done = true};
}

constexpr const char* kJson =
    R"({"number":3,"colour":"red","z":1.5,"note":null,"height":null,"steps":[1,2],"top":null,"done":true})";

std::string read_back(const std::string& json) {
  Reading reading;
  const Value root = parse_json(json).value();
  Climb read;
  KindOf<Climb>::read(Field(root, reading), read);
  const auto outcome = reading.outcome(std::move(read));
  return outcome ? to_json(*outcome) : outcome.error().sentence;
}

TEST(Row, IsWrittenInTheOrderOfItsMembers) {
  EXPECT_EQ(to_json(climb()), kJson);
  Climb high = climb();
  high.note = "windy";
  high.height = 2;
  high.top = icd::Point{.x = 1, .y = 2, .z = 3};
  EXPECT_EQ(to_json(high), R"({"number":3,"colour":"red","z":1.5,"note":"windy","height":2.0,"steps":[1,2],)"
                           R"("top":{"x":1.0,"y":2.0,"z":3.0},"done":true})");
}

TEST(Row, RejectsACountThatItsTypeCannotHold) {
  Reading reading;
  const Value root{std::int64_t{1} << 32};
  std::uint32_t count = 0;
  KindOf<std::uint32_t>::read(Field(root, reading), count);
  EXPECT_TRUE(reading.has_refusal());
}

TEST(Row, ReadsBackTheSame) {
  EXPECT_EQ(read_back(kJson), kJson);
}

TEST(Row, RejectsWithTheNameOfTheMember) {
  EXPECT_EQ(read_back("{}"), "number, colour, z, steps, done: missing");
  EXPECT_EQ(read_back(R"({"number":3,"colour":"red","z":1.5,"note":null,"height":"up"})"),
            "height: expected a number, got a string");
  EXPECT_EQ(read_back(R"({"number":3,"colour":"red","z":1.5,"note":null,"height":1,"steps":[-1]})"),
            "steps[0]: expected a whole number from 0 to 9223372036854775807, got -1");
}

struct Shaft {
  double depth = 0;
  std::optional<double> width = std::nullopt;
  icd::Point mouth = {}, end = {};
  std::vector<Climb> climbs = {};

  static const Row kRow;
};
constexpr Member kShaft[] = {member<&Shaft::depth>("depth"), member<&Shaft::width>("width"),
                             member<&Shaft::mouth>("mouth"), member<&Shaft::end>("end").exact(),
                             member<&Shaft::climbs>("climbs")};
constexpr Row Shaft::kRow = {"", kShaft};

TEST(Row, ChangesAllNumbersExceptExactOnes) {
  Shaft shaft = {.depth = 1, .width = 2, .mouth = {.x = 3, .y = 4, .z = 5}, .end = {.x = 6}};
  shaft.climbs = {climb(), climb()};
  shaft.climbs[1].top = icd::Point{.x = 7, .y = 8, .z = 9};
  change_numbers(Shaft::kRow, &shaft, [](double number) { return 10 * number; });
  EXPECT_EQ(shaft.depth, 10);
  EXPECT_EQ(shaft.width, 20);
  EXPECT_EQ(to_json(shaft.mouth), R"({"x":30.0,"y":40.0,"z":50.0})");
  EXPECT_EQ(shaft.end.x, 6);
  EXPECT_EQ(shaft.climbs[0].rope.end.z, 15);
  EXPECT_FALSE(shaft.climbs[0].top);
  EXPECT_EQ(shaft.climbs[1].top->z, 90);
}

TEST(Row, IsDescribedWithUnitsWordsAndBounds) {
  static constexpr auto kText = Schemas({&KindOf<Climb>::schema}).text();
  const std::string_view text(kText.data(), kText.size());
  EXPECT_EQ(text.substr(0, text.find_last_not_of(' ') + 1),
            R"({"Climb":{"type":"object","description":"One way up.","properties":{)"
            R"("number":{"type":"integer","minimum":1,"maximum":9},)"
            R"("colour":{"type":"string","enum":["red","blue"]},)"
            R"("z":{"type":"number","description":"metres"},"note":{"type":["string","null"]},)"
            R"("height":{"type":["number","null"]},)"
            R"("steps":{"type":"array","items":{"type":"integer","minimum":0}},)"
            R"("top":{"oneOf":[{"type":"null"},{"$ref":"#/components/schemas/Point"}],)"
            R"("description":"of the shaft"},"done":{"type":"boolean"}},)"
            R"("required":["number","colour","z","note","height","steps","top","done"],)"
            R"("additionalProperties":false},)"
            R"("Point":{"type":"object","description":"Metres, in the frame darpa.","properties":{)"
            R"("x":{"type":"number"},"y":{"type":"number"},"z":{"type":"number"}},)"
            R"("required":["x","y","z"],"additionalProperties":false}})");
}

}  // namespace
}  // namespace adit::codec
