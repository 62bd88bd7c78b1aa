// Processes of random lengths append to one log, and are killed, lose power, or meet a failing disk. Each
// process's reading is compared with the results that earlier processes got. Older copies and zeros must
// show.
#include <gmock/gmock.h>

#include <cstdlib>
#include <map>
#include <optional>

#include "store/disk.hpp"
#include "store/log.hpp"
#include "store/second_reader.hpp"

namespace adit::store {
namespace {

constexpr std::uint8_t kKind = 1;

std::uint64_t seeds() {
  const char* const told = std::getenv("ADIT_STORE_SEEDS");
  return told == nullptr ? 150 : std::strtoull(told, nullptr, 10);
}

/// The records that a start must find.
struct Book {
  std::vector<std::string> kept;    // certainly durable
  std::vector<std::string> unsure;  // accepted after them
  std::vector<std::string> tried;   // their appends have failed since, or were killed
  bool is_explained(const std::vector<std::string>& got) const {
    std::vector<std::string> all = kept;
    all.insert(all.end(), unsure.begin(), unsure.end());
    const bool begins =
        got.size() >= kept.size() &&
        std::equal(got.begin(), got.end(), all.begin(),
                   all.begin() + static_cast<std::ptrdiff_t>(std::min(got.size(), all.size())));
    return begins || is_tried(got, kept) || is_tried(got, all);
  }
  bool is_tried(const std::vector<std::string>& got, const std::vector<std::string>& before) const {
    return got.size() == before.size() + 1 && std::equal(before.begin(), before.end(), got.begin()) &&
           std::ranges::find(tried, got.back()) != tried.end();
  }
};

struct Found {
  std::vector<std::string> bodies;
  std::vector<std::string> gaps;
};
Found found_in(const Contents& contents) {
  Found found;
  for (const Item& item : contents.items) {
    if (const auto* record = std::get_if<Record>(&item)) found.bodies.emplace_back(record->body);
    if (const auto* gap = std::get_if<Gap>(&item))
      found.gaps.push_back(gap->file + ' ' + std::to_string(gap->first));
  }
  return found;
}

class Play {
 public:
  Play(std::uint64_t seed, bool on_disk)
      : random_(seed, "play"), disk_(Random(seed, "disk")), on_disk_(on_disk) {
    if (on_disk) keeping_ = {{512, 2}, 24 * 1024, true, 1u << 20};
    if (!on_disk) keeping_ = {kInMemory, 0, false, 1u << 20};
  }

  /// Runs a process. Returns a sentence about a violation, or "".
  std::string run() {
    const std::uint64_t processes = 1 + random_.uniform_index(6);
    for (std::uint64_t i = 0; i < processes && trouble_.empty(); ++i) {
      disk_.start();
      try {
        live();
      } catch (const Disk::Killed&) {
      }
      quiet();
      if (on_disk_ && random_.chance(0.6)) disk_.cut_power();
      copies_.push_back(disk_.files());
      if (on_disk_ && random_.chance(0.2)) disk_.flip_bit();
    }
    if (on_disk_ && trouble_.empty()) lose_what_was_synced();
    for (int i = 0; i < 2 && trouble_.empty(); ++i) {
      disk_.lengthen();
      disk_.start();
      try {
        live();
      } catch (const Disk::Killed&) {
      }
      quiet();
    }
    return trouble_;
  }

 private:
  void quiet() {
    disk_.kills = disk_.failing_syncs = disk_.failing_writes = disk_.full = disk_.failing_opens = 0;
  }

  void live() {
    const auto before = disk_.files();
    const SecondReading again = read_again(before);
    disk_.failing_opens = random_.chance(0.1) ? 0.2 : 0;
    const auto directory = Directory::lock(disk_.log());
    if (!directory) return;
    auto contents = Contents::read(*directory, keeping_);
    disk_.failing_opens = 0;
    if (!contents) {
      if (disk_.files() != before) trouble_ = "a failed read has changed a file";
      return;
    }
    const Found found = found_in(*contents);
    if (!found.gaps.empty()) trouble_ = "a gap at " + found.gaps.front();
    if (found.bodies != again.bodies() || !again.missing.empty() || contents->last != again.last)
      trouble_ = "the second reader disagrees";
    if (!book_.is_explained(found.bodies)) trouble_ = explain(found.bodies);
    if (!trouble_.empty()) return;

    disk_.kills = random_.chance(0.3) ? 0.02 : 0;
    disk_.failing_syncs = on_disk_ && random_.chance(0.4) ? 0.2 : 0;
    disk_.failing_writes = random_.chance(0.2) ? 0.1 : 0;
    disk_.full = random_.chance(0.2) ? 0.3 : 0;
    Log log(*directory, keeping_);
    const bool started = log.start(*contents).has_value();
    const std::size_t durable =
        started ? found.bodies.size() : std::min(found.bodies.size(), durable_in(*contents));
    book_ = {{found.bodies.begin(), found.bodies.begin() + static_cast<std::ptrdiff_t>(durable)},
             {found.bodies.begin() + static_cast<std::ptrdiff_t>(durable), found.bodies.end()},
             {}};
    if (!started && !on_disk_) return;
    for (std::uint64_t left = random_.uniform_index(40); left > 0; --left) step(*directory, log);
  }

  struct Reading {
    Found found;
    std::uint64_t last = 0, durable = 0;
  };
  std::optional<Reading> read() const {
    const auto directory = Directory::lock(disk_.log());
    const auto contents =
        directory ? Contents::read(*directory, keeping_) : std::unexpected(directory.error());
    if (!contents) return std::nullopt;
    return Reading{found_in(*contents), contents->last, contents->durable};
  }

  /// An older copy of all files is put back, or zeros are in one of them from some place on. The reading
  /// shows it, or its last number is below the durable one, which is why that is kept elsewhere. Then the
  /// files of before are put back.
  void lose_what_was_synced() {
    disk_.start();
    const auto before = disk_.files();
    const auto whole = read();
    if (before.empty() || !whole || !whole->found.gaps.empty()) return;
    const auto expect_shown = [&](const char* what) {
      const auto now = read();
      const bool is_shown = !now || !now->found.gaps.empty() || now->last < whole->durable;
      if (is_shown || now->found.bodies == whole->found.bodies) return;
      const std::size_t least = whole->found.bodies.size() - (whole->last - whole->durable);
      if (now->found.bodies.size() < least) trouble_ = std::string(what) + " shows in nothing";
    };
    disk_.replace(copies_[random_.uniform_index(copies_.size())]);
    expect_shown("an older copy");
    auto zeroed = before;
    std::string& bytes =
        std::next(zeroed.begin(), static_cast<std::ptrdiff_t>(random_.uniform_index(zeroed.size())))->second;
    if (!bytes.empty())
      std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(random_.uniform_index(bytes.size())), bytes.end(),
                '\0');
    disk_.replace(zeroed);
    expect_shown("a zeroed tail");
    disk_.replace(before);
  }

  static std::size_t durable_in(const Contents& contents) {
    std::size_t count = 0;
    for (const Item& item : contents.items) {
      const auto* record = std::get_if<Record>(&item);
      count += record != nullptr && record->sequence <= contents.durable ? 1 : 0;
    }
    return count;
  }

  void step(const Directory& directory, Log& log) {
    if (random_.chance(0.1)) return take_snapshot(directory, log);
    if (on_disk_ && random_.chance(0.05)) return void(make_spare(directory, keeping_, false));
    const bool now = !on_disk_ || random_.chance(0.6);
    std::string body = "record " + std::to_string(++count_) + ' ';
    if (random_.chance(0.1)) body.resize(random_.uniform_index(3000), 'x');
    book_.tried.push_back(body);
    const auto appended = log.append(kKind, body, now ? Durability::Now : Durability::Soon);
    if (!appended) return;
    book_.tried.clear();
    book_.unsure.push_back(body);
    if (now) settle();
  }

  void settle() {
    book_.kept.insert(book_.kept.end(), book_.unsure.begin(), book_.unsure.end());
    book_.unsure.clear();
  }

  void take_snapshot(const Directory& directory, Log& log) {
    if (!log.turn()) return;
    book_.tried.clear();
    settle();
    auto snapshot = Snapshot::begin(directory, keeping_, log);
    if (!snapshot) return;
    for (const std::string& body : book_.kept) {
      if (!snapshot->add(kKind, body)) return;
    }
    (void)snapshot->finish();
  }

  std::string explain(const std::vector<std::string>& got) const {
    return std::to_string(got.size()) + " records, of " + std::to_string(book_.kept.size()) +
           " durable and " + std::to_string(book_.unsure.size()) + " other ones";
  }

  Random random_;
  Disk disk_;
  const bool on_disk_;
  LogOptions keeping_;
  Book book_;
  std::vector<std::map<std::string, std::string>> copies_;  // of the files, after each process
  std::uint64_t count_ = 0;
  std::string trouble_;
};

void play(bool on_disk) {
  std::map<std::string, std::vector<std::uint64_t>> failed;
  for (std::uint64_t seed = 1; seed <= seeds(); ++seed) {
    const std::string trouble = Play(seed, on_disk).run();
    if (!trouble.empty()) failed[trouble].push_back(seed);
  }
  EXPECT_THAT(failed, testing::IsEmpty());
}

TEST(PlayLog, SurvivesKillsPowerCutsAndFailuresOnDisk) {
  play(true);
}

TEST(PlayLog, SurvivesKillsAndFailuresInMemory) {
  play(false);
}

TEST(LogFiles, LeavesNoFileThatItCannotOpen) {
  Disk disk(Random(1, "disk"));
  disk.start();
  const auto directory = Directory::lock(disk.log()).value();
  const LogOptions keeping{{512, 2}, 8192, true};
  Log log(directory, keeping);
  ASSERT_TRUE(log.start(Contents::read(directory, keeping).value()));
  ASSERT_TRUE(log.append(kKind, "a", Durability::Now));
  ASSERT_TRUE(make_spare(directory, keeping, false));
  disk.failing_file = "log-";
  ASSERT_FALSE(log.turn());
  EXPECT_EQ(directory.files().value().size(), 1) << "the file with the record";
}

}  // namespace
}  // namespace adit::store
