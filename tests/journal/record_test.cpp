#include "journal/record.hpp"

#include <gmock/gmock.h>

#include <string>
#include <utility>
#include <vector>

namespace adit::journal {
namespace {

using Records = std::vector<std::pair<Kind, std::string>>;

Records records_in(std::string_view bytes) {
  Records all;
  for_each_record(bytes, [&](Kind kind, std::string_view said) {
    all.emplace_back(kind, said);
    return true;
  });
  return all;
}

const Records kThree = {
    {Kind::Poses, "a state"}, {Kind::StateSent, ""}, {Kind::Markers, std::string(300, '\0')}};

std::string written(const Records& records) {
  std::string bytes;
  for (const auto& [kind, said] : records) bytes += framed(kind, said);
  return bytes;
}

Records first(std::size_t count) {
  return {kThree.begin(), kThree.begin() + static_cast<std::ptrdiff_t>(count)};
}

TEST(Record, IsReadAsItWasWritten) {
  EXPECT_EQ(records_in(written(kThree)), kThree);
  EXPECT_EQ(records_in(""), Records{});
}

TEST(Record, IsThereWholeOrNotAtAllWhereverTheFileIsCut) {
  const std::string bytes = written(kThree);
  for (std::size_t cut = 0; cut < bytes.size(); ++cut) {
    std::size_t whole = 0;
    while (written(first(whole + 1)).size() <= cut) ++whole;
    ASSERT_EQ(records_in(std::string_view(bytes).substr(0, cut)), first(whole)) << "cut at " << cut;
  }
}

TEST(Record, ThatIsDamagedEndsTheFileAndIsNeverReadAsAnother) {
  const std::string bytes = written(kThree);
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    for (const int bit : {0, 3, 7}) {
      std::string damaged = bytes;
      damaged[at] = static_cast<char>(damaged[at] ^ (1 << bit));
      std::size_t before = 0;
      while (written(first(before + 1)).size() <= at) ++before;
      ASSERT_EQ(records_in(damaged), first(before)) << "byte " << at << ", bit " << bit;
    }
  }
}

TEST(Record, OfZerosIsNone) {
  EXPECT_EQ(records_in(std::string(100, '\0')), Records{});
}

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

TEST(Reader, DoesNotReadPastTheEndWhereALengthIsWrong) {
  Reader reader(std::string_view("\xff\xff\xff\xff\xff\xff\xff\xff text", 13));
  EXPECT_EQ(reader.text(), "");
  EXPECT_FALSE(reader.ok());
}

}  // namespace
}  // namespace adit::journal
