#include "archive/record.hpp"

#include <gmock/gmock.h>

#include <string>
#include <utility>
#include <vector>

namespace adit::archive {
namespace {

using Records = std::vector<std::pair<Kind, std::string>>;

Records records_in(std::string_view bytes) {
  Records all;
  for_each_record(bytes, [&](Kind kind, std::string_view said) { all.emplace_back(kind, said); });
  return all;
}

const Records kThree = {{Kind::Poses, "poses"}, {Kind::Wiped, ""}, {Kind::Tile, std::string(300, '\0')}};

std::string written(const Records& records) {
  std::string bytes;
  for (const auto& [kind, said] : records) bytes += framed(kind, said);
  return bytes;
}

TEST(ArchiveRecord, IsReadAsItWasWritten) {
  EXPECT_EQ(records_in(written(kThree)), kThree);
  EXPECT_EQ(records_in(""), Records{});
  const Records largest = {{Kind::Tile, std::string(kLargestRecord - 1, '\xA7')}};
  EXPECT_EQ(records_in(written(largest)), largest);
}

TEST(ArchiveRecord, ThatIsDamagedIsTheOnlyOneThatIsLost) {
  const std::string bytes = written(kThree);
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x20);
    Records left = kThree;
    std::size_t which = 0;
    while (written({kThree.begin(), kThree.begin() + static_cast<std::ptrdiff_t>(which) + 1}).size() <= at)
      ++which;
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(which));
    ASSERT_EQ(records_in(damaged), left) << "byte " << at;
  }
}

TEST(ArchiveRecord, ThatIsTornIsPassedOverWhateverFollows) {
  const std::string bytes = written(kThree), more = framed(Kind::Layer, "later");
  for (std::size_t cut = 0; cut < bytes.size(); ++cut) {
    Records whole;
    for (const auto& record : kThree) {
      whole.push_back(record);
      if (written(whole).size() > cut) break;
    }
    if (written(whole).size() > cut) whole.pop_back();
    whole.emplace_back(Kind::Layer, "later");
    ASSERT_EQ(records_in(bytes.substr(0, cut) + more), whole) << "cut at " << cut;
  }
}

TEST(ArchiveRecord, IsSoughtForAWhileInAFileThatIsDamagedAllOver) {
  std::string bytes;
  for (int i = 0; i < 100'000; ++i)
    bytes += framed(Kind::Layer, "").substr(0, 4) + std::string("\x00\x00\x01\x00", 4);
  EXPECT_EQ(records_in(bytes + framed(Kind::Wiped, "")), Records{}) << "each costs the checksum of 64 KiB";
}

}  // namespace
}  // namespace adit::archive
