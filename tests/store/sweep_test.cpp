// A log after a flipped bit in each byte, a cut at each byte, or the loss of each file, in turn.
#include <gmock/gmock.h>

#include "store/second_reader.hpp"
#include "store/small_log.hpp"

namespace adit::store {
namespace {

/// A snapshot, and two files after it.
class SweepLog : public testing::Test {
 protected:
  void make(const LogOptions& keeping) {
    small_.emplace(keeping);
    small_->fill({"a", "b", "c"}, Durability::Now);
    small_->snapshot({"abc"});
    small_->fill({"d", std::string(900, 'e'), "f", "g", "h", "i"}, Durability::Now);
    if (!keeping.syncs) small_->open().log.turn().value();
    small_->fill({"j", "k"}, Durability::Now);
    files_ = small_->files();
    all_ = bodies(*small_->read());
  }

  /// Makes each of `changes` at each non-zero byte of each file.
  void for_each_byte(const std::function<void(std::string&, std::size_t)>& change,
                     const std::function<void()>& check) {
    for (const auto& [name, bytes] : files_) {
      for (std::size_t at = 0; at < bytes.size(); ++at) {
        if (bytes[at] == 0 && at % 64 != 0) continue;
        SCOPED_TRACE(name + " at " + std::to_string(at));
        std::string changed = bytes;
        change(changed, at);
        small_->write(name, changed);
        check();
        if (HasFailure()) return;
      }
      small_->write(name, bytes);
    }
  }

  void expect_all() {
    const auto contents = small_->read();
    ASSERT_TRUE(contents);
    EXPECT_EQ(bodies(*contents), all_);
    EXPECT_FALSE(has_gap(*contents));
    EXPECT_EQ(read_again(small_->files()).bodies(), all_);
  }
  /// Checks that all records are there or reported missing.
  void expect_told() {
    const auto contents = small_->read();
    ASSERT_TRUE(contents);
    std::vector<std::string> got = bodies(*contents);
    if (got.size() > 2 && got[2] == "c")
      got.erase(got.begin(), got.begin() + 2), got[0] = "abc";  // without the snapshot
    EXPECT_TRUE(std::ranges::includes(all_, got));
    EXPECT_TRUE(got.size() == all_.size() || has_gap(*contents)) << got.size();
  }

  std::optional<SmallLog> small_;
  std::map<std::string, std::string> files_;
  std::vector<std::string> all_;
};

TEST_F(SweepLog, FlippedBitOnDiskLosesNothing) {
  make(kSmall);
  for_each_byte([](std::string& bytes, std::size_t at) { bytes[at] ^= static_cast<char>(1 << at % 8); },
                [&] { expect_all(); });
}

TEST_F(SweepLog, FlippedBitOnDiskKeepsTheLastRecord) {
  make(kSmall);
  const auto log =
      std::ranges::find_if(files_, [](const auto& file) { return file.first.starts_with("snapshot"); });
  const auto& [name, bytes] = *std::prev(log);
  const std::size_t end = bytes.find_last_not_of('\0') / 512 * 512 + 512;
  for (std::size_t bit = (end - 1024) * 8; bit < end * 8; ++bit) {
    std::string changed = bytes;
    changed[bit / 8] ^= static_cast<char>(1 << bit % 8);
    small_->write(name, changed);
    SCOPED_TRACE(bit);
    expect_all();
  }
}

TEST_F(SweepLog, TruncatedFileOnDiskIsReported) {
  make(kSmall);
  for_each_byte([](std::string& bytes, std::size_t at) { bytes.resize(at); }, [&] { expect_told(); });
}

/// Except for the last file, whose number the log's user knows.
TEST_F(SweepLog, MissingFileIsReported) {
  make(kSmall);
  const auto missing = std::next(files_.begin());  // the first one is older than the snapshot
  ASSERT_THAT(missing->first, testing::StartsWith("log-00000002"));
  std::filesystem::remove(small_->path() + '/' + missing->first);
  EXPECT_TRUE(has_gap(*small_->read()));
}

/// Except for the last record, which may be torn.
TEST_F(SweepLog, DamagedRecordInMemoryIsReportedAndLostAlone) {
  make({kInMemory, 0, false});
  all_.pop_back();
  for_each_byte([](std::string& bytes, std::size_t at) { bytes[at] ^= static_cast<char>(1 << at % 8); },
                [&] {
                  const auto contents = small_->read();
                  std::vector<std::string> got = bodies(*contents);
                  if (!got.empty() && got.back() == "k") got.pop_back();
                  EXPECT_GE(got.size() + 1, all_.size());
                  EXPECT_TRUE(got == all_ || has_gap(*contents));
                  EXPECT_TRUE(std::ranges::includes(all_, got));
                });
}

}  // namespace
}  // namespace adit::store
