// What a client of ours makes of patches that are none: it never takes them, and they cost it nothing.
#include "codec/apply_patch.hpp"

#include <gmock/gmock.h>

#include "codec/json.hpp"

namespace adit::codec {
namespace {

/// As JSON; "": it is no patch of that.
std::string patched_text(std::string_view before, std::string_view patch) {
  const auto now = apply_patch(parse_json(before).value(), parse_json(patch).value());
  return now ? write_json(*now) : "";
}

constexpr std::string_view kView =
    R"({"at":{"x":1,"y":2},"none":null,"rows":[{"n":1,"a":"x"},{"n":2,"a":"y"}]})";

std::string patched_view(std::string_view patch) {
  return patched_text(kView, patch);
}

TEST(ApplyPatch, ChangesWhatThePatchNames) {
  EXPECT_EQ(patched_view("{}"), kView);
  EXPECT_EQ(patched_view(R"({"at":{"y":3},"none":{"z":4}})"),
            R"({"at":{"x":1,"y":3},"none":{"z":4},"rows":[{"n":1,"a":"x"},{"n":2,"a":"y"}]})");
  EXPECT_EQ(patched_view(R"({"at":null,"rows":{"length":1}})"),
            R"({"at":null,"none":null,"rows":[{"n":1,"a":"x"}]})");
  EXPECT_EQ(patched_view(R"({"rows":{"length":3,"kept":[[1,0,2]],"rows":{"0":{"n":3},"2":{"a":"z"}}}})"),
            R"({"at":{"x":1,"y":2},"none":null,"rows":[{"n":3},{"n":1,"a":"x"},{"n":2,"a":"z"}]})");
}

TEST(ApplyPatch, IsNothingWhereThePatchIsNoneOfThat) {
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
