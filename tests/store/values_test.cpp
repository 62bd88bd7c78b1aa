#include "store/values.hpp"

#include <gmock/gmock.h>

#include <string>

namespace adit::store {
namespace {

TEST(Reader, GivesBackWhatAWriterWrote) {
  const std::string bytes = Writer().number(~std::uint64_t{0}).real(-0.1).text("a\0b").text("").finish();
  Reader reader(bytes);
  EXPECT_EQ(reader.number(), ~std::uint64_t{0});
  EXPECT_EQ(reader.real(), -0.1);
  EXPECT_EQ(reader.text(), "a");
  EXPECT_EQ(reader.text(), "");
  EXPECT_TRUE(reader.ok());
  EXPECT_EQ(reader.number(), 0u);
  EXPECT_FALSE(reader.ok()) << "there is no more";
}

TEST(Reader, DoesNotReadPastTheEndIfALengthIsWrong) {
  Reader reader(std::string_view("\xff\xff\xff\xff\xff\xff\xff\xff text", 13));
  EXPECT_EQ(reader.text(), "");
  EXPECT_FALSE(reader.ok());
}

}  // namespace
}  // namespace adit::store
