#include <gmock/gmock.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "store/frame.hpp"

namespace adit::store {
namespace {

enum class Colour : std::uint8_t { Red, Green };

struct Part {
  int number = 0;
  std::optional<double> real = {};
  friend bool operator==(const Part&, const Part&) = default;
};

struct Whole {
  std::string text = "";
  Colour colour = Colour::Red;
  bool is_so = false;
  std::vector<Part> parts = {};
  std::array<std::pair<double, std::uint64_t>, 2> pairs = {};
  std::chrono::nanoseconds time{};
  std::chrono::steady_clock::time_point at{};
  friend bool operator==(const Whole&, const Whole&) = default;
};

}  // namespace

template <>
inline constexpr auto kMembers<Part> = std::tuple(&Part::number, &Part::real);
template <>
inline constexpr auto kMembers<Whole> = std::tuple(&Whole::text, &Whole::colour, &Whole::is_so, &Whole::parts,
                                                   &Whole::pairs, &Whole::time, &Whole::at);

namespace {

const Whole kWhole{.text = "a\xff",
                   .colour = Colour::Green,
                   .is_so = true,
                   .parts = {{-3, 0.5}, {4, {}}},
                   .pairs = {{{-0.1, ~std::uint64_t{0}}, {2, 3}}},
                   .time = std::chrono::nanoseconds(-5),
                   .at = std::chrono::steady_clock::time_point(std::chrono::seconds(6))};

TEST(Values, ReadBackTheSame) {
  Whole other{.text = "x", .parts = {{1, 2}}};
  double real = 0;
  ASSERT_TRUE(read(bytes_of(kWhole, 7.5), other, real));
  EXPECT_EQ(other, kWhole);
  EXPECT_EQ(real, 7.5);
}

TEST(Values, AreReadWhollyOrNotAtAll) {
  const std::string bytes = bytes_of(kWhole);
  Whole other;
  for (std::size_t cut = 0; cut < bytes.size(); ++cut)
    EXPECT_FALSE(read(bytes.substr(0, cut), other)) << "cut at " << cut;
  EXPECT_FALSE(read(bytes + 'x', other));
}

TEST(Values, OfAnEarlierVersionLackTheLastMembers) {
  const std::string bytes = bytes_of(Part{.number = 5, .real = 0.5});
  const std::size_t first = bytes_of(5).size();
  for (std::size_t size = 0; size <= bytes.size(); ++size) {
    Part part{.real = 7};
    Reader reader(std::string_view(bytes).substr(0, size));
    read_first_members<1>(reader, part);
    EXPECT_EQ(reader.ok(), size == first || size == bytes.size()) << size;
    if (reader.ok()) EXPECT_EQ(part.real, size == first ? 7 : 0.5);
  }
}

TEST(Reader, ReturnsNothingAfterTheEnd) {
  const std::string bytes = bytes_of(1u);
  Reader reader(bytes);
  EXPECT_EQ(reader.read<std::uint64_t>(), 1u);
  EXPECT_TRUE(reader.ok());
  EXPECT_EQ(reader.read<std::uint64_t>(), 0u);
  EXPECT_FALSE(reader.ok()) << "no further values";
}

TEST(Reader, DoesNotReadPastTheEndForAWrongLength) {
  for (const std::string_view huge : {std::string_view("\xff\xff\xff\xff\xff\xff\xff\xff text", 13)}) {
    std::string text;
    std::vector<int> list;
    EXPECT_FALSE(read(huge, text));
    EXPECT_EQ(text, "");
    EXPECT_FALSE(read(huge, list));
    EXPECT_LT(list.size(), 2u);
  }
}

TEST(Reader, RejectsNumbersThatDoNotFit) {
  std::int32_t number = 0;
  bool is_so = false;
  EXPECT_TRUE(read(bytes_of(std::int64_t{INT32_MIN}), number));
  EXPECT_EQ(number, INT32_MIN);
  EXPECT_FALSE(read(bytes_of(std::int64_t{INT32_MIN} - 1), number));
  EXPECT_FALSE(read(bytes_of(2), is_so));
}

}  // namespace
}  // namespace adit::store
