#include <gtest/gtest.h>

#include <limits>

#include "host/files.hpp"
#include "host/folder.hpp"

namespace adit::host {
namespace {

constexpr std::uint64_t kLargest = std::numeric_limits<std::uint64_t>::max();

std::optional<std::uint64_t> number_in(std::string_view name) {
  return number_in_name(name, "map-", ".cbor");
}

TEST(NumberedName, HasAtLeastEightDigits) {
  EXPECT_EQ(numbered_name("map-", 12, ".cbor"), "map-00000012.cbor");
  EXPECT_EQ(numbered_name("journal-", 123'456'789), "journal-123456789");
  EXPECT_EQ(numbered_name("", 0), "00000000");
}

TEST(NumberedName, ReadsBackItsNumber) {
  for (const std::uint64_t number : {std::uint64_t{0}, std::uint64_t{12}, std::uint64_t{99'999'999},
                                     std::uint64_t{100'000'000}, kLargest}) {
    EXPECT_EQ(number_in(numbered_name("map-", number, ".cbor")), number);
    EXPECT_EQ(number_in_name(numbered_name("journal-", number), "journal-"), number);
  }
}

TEST(NumberedName, IsReadWithAnyNumberOfDigits) {
  EXPECT_EQ(number_in("map-7.cbor"), 7u);
  EXPECT_EQ(number_in("map-0.cbor"), 0u);
  EXPECT_EQ(number_in("map-000000000000000000000000000007.cbor"), 7u);
  EXPECT_EQ(number_in_name("7.json", "", ".json"), 7u);
}

TEST(NumberedName, RejectsOtherFiles) {
  for (const char* name :
       {"", "map-", ".cbor", "map-.cbor", "map-1", "1.cbor", "map-1.cbor.damaged", "map-1.cborr",
        "xmap-1.cbor", "map-x.cbor", "map-1x.cbor", "map-x1.cbor", "map-1.0.cbor", "map- 1.cbor",
        "map-1 .cbor", "map--1.cbor", "map-+1.cbor", "map-0x1.cbor", "state.cbor"}) {
    EXPECT_EQ(number_in(name), std::nullopt) << name;
  }
  EXPECT_EQ(number_in_name("journal-", "journal-"), std::nullopt);
  EXPECT_EQ(number_in_name("journal-1.part", "journal-"), std::nullopt);
  EXPECT_EQ(number_in_name(".json", "", ".json"), std::nullopt);
  EXPECT_EQ(number_in_name("aba", "ab", "ba"), std::nullopt) << "the two share a letter";
}

TEST(NumberedName, RejectsTooLargeANumber) {
  EXPECT_EQ(number_in("map-18446744073709551615.cbor"), kLargest);
  EXPECT_EQ(number_in("map-18446744073709551616.cbor"), std::nullopt);
  EXPECT_EQ(number_in("map-99999999999999999999999.cbor"), std::nullopt);
}

TEST(NumberedName, IsListedInTheOrderOfNumbers) {
  const Folder folder;
  for (const char* name : {"map-10.cbor", "map-00000009.cbor", "map-100000000.cbor", "map-x.cbor", "map-1"}) {
    folder.put(name, "");
  }
  EXPECT_EQ(numbers_in(folder.path(), "map-", ".cbor"), (std::vector<std::uint64_t>{9, 10, 100'000'000}));
  EXPECT_EQ(numbers_in(folder / "none", "map-", ".cbor"), std::vector<std::uint64_t>());
  const std::string file = folder / "map-00000009.cbor";
  EXPECT_EQ(numbers_in(file, "map-").error(), file + ": Not a directory");
}

}  // namespace
}  // namespace adit::host
