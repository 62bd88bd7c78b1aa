#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "archive/record_kinds.hpp"

namespace adit::archive {
namespace {

using Records = std::vector<std::string>;

Records records_in(std::string_view bytes) {
  Records all;
  for_each_record(bytes, [&](std::string_view body) { all.emplace_back(body); });
  return all;
}

const Records kThree = {"poses", "w", std::string(300, '\0')};

std::string written(const Records& records) {
  std::string bytes;
  for (const std::string& body : records) bytes += frame_record(body);
  return bytes;
}

TEST(ArchiveRecord, ReadsBackTheSame) {
  EXPECT_EQ(records_in(written(kThree)), kThree);
  EXPECT_EQ(records_in(""), Records{});
  const Records largest = {std::string(kLargestRecord, '\xA7')};
  EXPECT_EQ(records_in(written(largest)), largest);
}

TEST(ArchiveRecord, DamagedIsLostAlone) {
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

TEST(ArchiveRecord, TornIsSkipped) {
  const std::string bytes = written(kThree), more = frame_record("later");
  for (std::size_t cut = 0; cut < bytes.size(); ++cut) {
    Records whole;
    for (const std::string& record : kThree) {
      whole.push_back(record);
      if (written(whole).size() > cut) break;
    }
    if (written(whole).size() > cut) whole.pop_back();
    whole.emplace_back("later");
    ASSERT_EQ(records_in(bytes.substr(0, cut) + more), whole) << "cut at " << cut;
  }
}

TEST(ArchiveRecord, SearchInADamagedFileIsBounded) {
  std::string bytes;
  for (int i = 0; i < 100'000; ++i)
    bytes += frame_record("x").substr(0, 8) + std::string("\x00\x00\x01\x00", 4);
  EXPECT_EQ(records_in(bytes + frame_record("x")), Records{}) << "each costs the checksum of 64 KiB";
}

}  // namespace
}  // namespace adit::archive
