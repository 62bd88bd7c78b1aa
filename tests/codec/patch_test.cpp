#include "codec/patch.hpp"

#include <gmock/gmock.h>

#include <random>

#include "codec/json.hpp"
#include "codec/patched.hpp"

namespace adit::codec {
namespace {

struct Step {
  std::uint64_t number = 0;
  std::string note;
  std::optional<double> height;

  static const Row kRow;
};

/// Its members are inlined in a way.
struct Mark {
  double depth = 0;
  std::optional<double> width;

  static const Row kRow;
};

struct Way {
  double now = 0;
  Mark at = {};
  std::optional<Step> top;
  std::vector<Step> steps;
  std::vector<std::uint64_t> marks;
  std::vector<Step> unnamed;

  static const Row kRow;
};

/// Steps that only their indices identify.
struct Unnamed {
  static Value write(const std::vector<Step>& steps);
  static void read(const Field& field, std::vector<Step>& steps);
  static Rows rows(std::vector<Step>& steps) { return KindOf<std::vector<Step>>::rows(steps); }
  static const Schema schema;
};

constexpr std::string_view kByNumber[] = {"number"};
constexpr Member kStep[] = {member<&Step::number>("number"), member<&Step::note>("note"),
                            member<&Step::height>("height")};
constexpr Row kUnnamed = {"", kStep};
constexpr Row Step::kRow = {"Step", kStep, "", kByNumber};
constexpr Schema kUnnamedStep = {.row = &kUnnamed};
constexpr Schema Unnamed::schema = {.type = "array", .items = &kUnnamedStep};
Value Unnamed::write(const std::vector<Step>& steps) {
  return json(steps);
}
void Unnamed::read(const Field& field, std::vector<Step>& steps) {
  KindOf<std::vector<Step>>::read(field, steps);
}

/// Writes itself in another form than it is stored.
struct InWords {
  static Value write(double depth) { return {std::string(depth < 10 ? "shallow" : "deep")}; }
  static void read(const Field& field, double& depth) { depth = field.text() == "deep" ? 10 : 0; }
  static constexpr Schema schema = {.type = "string"};
};

constexpr Member kMark[] = {member<&Mark::depth>("depth").as(kind_as<double, InWords>),
                            member<&Mark::width>("width")};
constexpr Row Mark::kRow = {"", kMark};

constexpr Member kWay[] = {
    member<&Way::now>("now"),     member<&Way::at>(""),
    member<&Way::top>("top"),     member<&Way::steps>("steps"),
    member<&Way::marks>("marks"), member<&Way::unnamed>("unnamed").as(kind_as<std::vector<Step>, Unnamed>)};
constexpr Row Way::kRow = {"Way", kWay};

Way way() {
  return {.now = 1,
          .at = {},
          .top = std::nullopt,
          .steps = {{1, "a", 0.5}, {2, "b", {}}, {3, "c", {}}},
          .marks = {7},
          .unnamed = {}};
}

/// The patch as JSON; "" if there is no change.
std::string patch_text(const Way& before, const Way& now) {
  const auto found = patch(before, now);
  return found ? write_json(*found) : "";
}

TEST(Patch, IsEmptyIfNothingChanged) {
  EXPECT_EQ(patch_text(way(), way()), "");
}

TEST(Patch, HasTheChangedMembers) {
  Way now = way();
  now.now = 2;
  now.marks.push_back(8);
  now.top = Step{.number = 9, .note = "", .height = 2};
  EXPECT_EQ(patch_text(way(), now), R"({"now":2.0,"top":{"number":9,"note":"","height":2.0},"marks":[7,8]})");
  Way next = now;
  next.top->height.reset();
  EXPECT_EQ(patch_text(now, next), R"({"top":{"height":null}})");
  EXPECT_EQ(patch_text(now, way()), R"({"now":1.0,"top":null,"marks":[7]})");
}

TEST(Patch, HasDerivedAndInlinedMembers) {
  Way now = way();
  now.at = {.depth = 3, .width = 0.5};
  EXPECT_EQ(patch_text(way(), now), R"({"width":0.5})") << "both depths are written as shallow";
  now.at.depth = 30;
  EXPECT_EQ(patch_text(way(), now), R"({"depth":"deep","width":0.5})");
}

TEST(Patch, OfARowHasItsPlaceAndItsChangedMembers) {
  Way now = way();
  now.steps[1].note = "B";
  EXPECT_EQ(patch_text(way(), now), R"({"steps":{"rows":{"1":{"note":"B"}}}})");
}

TEST(Patch, InsertsANewFirstRow) {
  Way now = way();
  now.steps.insert(now.steps.begin(), Step{.number = 4, .note = "d", .height = {}});
  EXPECT_EQ(patch_text(way(), now),
            R"({"steps":{"length":4,"kept":[[1,0,3]],"rows":{"0":{"number":4,"note":"d","height":null}}}})");
}

TEST(Patch, RemovesAndMovesRows) {
  Way now = way();
  now.steps.erase(now.steps.begin() + 1);
  EXPECT_EQ(patch_text(way(), now), R"({"steps":{"length":2,"kept":[[0,0,1],[1,2,1]]}})");
  now = way();
  now.steps.pop_back();
  EXPECT_EQ(patch_text(way(), now), R"({"steps":{"length":2}})");
  std::swap(now.steps[0], now.steps[1]);
  now.steps[0].note = "B";
  EXPECT_EQ(patch_text(way(), now),
            R"({"steps":{"length":2,"kept":[[0,1,1],[1,0,1]],"rows":{"0":{"note":"B"}}}})");
  now.steps.clear();
  EXPECT_EQ(patch_text(way(), now), R"({"steps":{"length":0}})");
}

TEST(Patch, IdentifiesUnnamedRowsByPlace) {
  Way before = way(), now = way();
  before.unnamed = {{1, "a", {}}, {2, "b", {}}};
  now.unnamed = {{2, "b", {}}, {2, "b", {}}, {5, "e", {}}};
  EXPECT_EQ(
      patch_text(before, now),
      R"({"unnamed":{"length":3,"rows":{"0":{"number":2,"note":"b"},"2":{"number":5,"note":"e","height":null}}}})");
}

TEST(Patch, UsesNoUserTextAsAName) {
  Way now = way();
  now.steps.insert(now.steps.begin(), Step{.number = 4, .note = "secret", .height = {}});
  const std::string text = patch_text(way(), now);
  EXPECT_NE(text.find(R"("secret")"), std::string::npos);
  EXPECT_EQ(text.find(R"("secret":)"), std::string::npos);
}

using Random = std::mt19937_64;

Step any_step(Random& random) {
  return {.number = random() % 12,
          .note = std::string(random() % 3, 'x'),
          .height = random() % 3 == 0 ? std::nullopt : std::optional(static_cast<double>(random() % 3))};
}

/// Random changes of a list: elements are added, removed, changed and moved. Two may have the same number.
void change_some(Random& random, std::vector<Step>& steps) {
  for (std::uint64_t i = random() % 4; i > 0; --i) {
    const auto any = steps.begin() + static_cast<std::ptrdiff_t>(random() % (steps.size() + 1));
    const bool is_row = any != steps.end();
    switch (random() % 5) {
      case 0:
        steps.insert(any, any_step(random));
        break;
      case 1:
        if (is_row) steps.erase(any);
        break;
      case 2:
        if (is_row) any->note += "y";
        break;
      case 3:
        if (is_row) std::iter_swap(any, steps.begin());
        break;
      default:
        if (is_row) *any = any_step(random);
    }
  }
}

void change_some(Random& random, Way& way) {
  way.now += static_cast<double>(random() % 2);
  if (random() % 3 == 0) way.top = random() % 3 == 0 ? std::nullopt : std::optional(any_step(random));
  if (random() % 3 == 0) way.at.depth = static_cast<double>(random() % 20);
  if (random() % 3 == 0) way.at.width = random() % 2 == 0 ? std::nullopt : std::optional(0.5);
  if (random() % 3 == 0) way.marks.resize(random() % 3, random() % 4);
  change_some(random, way.steps);
  change_some(random, way.unnamed);
}

/// The value as a client parses it.
Value read_again(const Value& value) {
  return parse_json(write_json(value)).value();
}

TEST(Patch, TurnsAnyViewIntoTheNext) {
  Random random(7);
  for (int client = 0; client < 6; ++client) {
    Way sent = way(), now = sent;
    Value known = read_again(json(sent));
    for (int step = 0; step < 100; ++step) {
      change_some(random, now);
      const auto change = patch(sent, now);
      ASSERT_EQ(change.has_value(), json(sent) != json(now));
      if (!change) continue;
      const auto applied = apply_patch(known, read_again(*change));
      known = test::patched(known, read_again(*change));
      ASSERT_TRUE(applied && *applied == known) << "our client has another result";
      ASSERT_EQ(write_json(known), write_json(read_again(json(now)))) << write_json(*change);
      sent = now;
    }
  }
}

// How our client handles invalid patches: it rejects them at little cost.

/// The patched value as JSON; "" if the patch does not fit.
std::string patched_text(std::string_view before, std::string_view patch) {
  const auto now = apply_patch(parse_json(before).value(), parse_json(patch).value());
  return now ? write_json(*now) : "";
}

constexpr std::string_view kView =
    R"({"at":{"x":1,"y":2},"none":null,"rows":[{"n":1,"a":"x"},{"n":2,"a":"y"}]})";

std::string patched_view(std::string_view patch) {
  return patched_text(kView, patch);
}

TEST(ApplyPatch, ChangesTheNamedMembers) {
  EXPECT_EQ(patched_view("{}"), kView);
  EXPECT_EQ(patched_view(R"({"at":{"y":3},"none":{"z":4}})"),
            R"({"at":{"x":1,"y":3},"none":{"z":4},"rows":[{"n":1,"a":"x"},{"n":2,"a":"y"}]})");
  EXPECT_EQ(patched_view(R"({"at":null,"rows":{"length":1}})"),
            R"({"at":null,"none":null,"rows":[{"n":1,"a":"x"}]})");
  EXPECT_EQ(patched_view(R"({"rows":{"length":3,"kept":[[1,0,2]],"rows":{"0":{"n":3},"2":{"a":"z"}}}})"),
            R"({"at":{"x":1,"y":2},"none":null,"rows":[{"n":3},{"n":1,"a":"x"},{"n":2,"a":"z"}]})");
}

TEST(ApplyPatch, RejectsInvalidRows) {
  for (const std::string_view rows :
       {R"({"length":-1})", R"({"length":"2"})", R"({"length":18446744073709551615})", R"({"length":100001})",
        R"({"kept":1})", R"({"kept":[1]})", R"({"kept":[[0,0]]})", R"({"kept":[[0,0,3]]})",
        R"({"kept":[[1,0,2]]})", R"({"kept":[[0,18446744073709551615,2]]})", R"({"kept":[[0,-1,1]]})",
        R"({"rows":[1]})", R"({"rows":{"2":{}}})", R"({"rows":{"-1":{}}})", R"({"rows":{"":{}}})",
        R"({"rows":{"1x":{}}})", R"({"rows":{"99999999999999999999":{}}})"}) {
    EXPECT_EQ(patched_view(R"({"rows":)" + std::string(rows) + "}"), "") << rows;
  }
}

}  // namespace
}  // namespace adit::codec
