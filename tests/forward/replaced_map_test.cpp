// A delivered map replaces an older, rejected one: the order of the two writes.
#include <gtest/gtest.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "../uplink/peer.hpp"
#include "forward/fixtures.hpp"
#include "forward/sample_maps.hpp"
#include "loop/file_descriptor.hpp"
#include "loop/turn_until.hpp"

namespace adit::forward {
namespace {

/// Changes of two directories in order.
class WatchedDirectories {
 public:
  WatchedDirectories(const std::string& one, const std::string& other)
      : inotify_(::inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {
    ::inotify_add_watch(inotify_.get(), one.c_str(), IN_MOVED_TO);
    ::inotify_add_watch(inotify_.get(), other.c_str(), IN_DELETE);
  }
  /// Names created in the first directory or removed from the second.
  std::vector<std::string> names() {
    alignas(inotify_event) std::array<char, 4096> read{};
    const ssize_t count = ::read(inotify_.get(), read.data(), read.size());
    for (ssize_t at = 0; at < count;) {
      inotify_event event{};
      std::memcpy(&event, read.data() + at, sizeof event);
      const std::string_view name = read.data() + at + sizeof event;
      if (name != "at-work") names_.emplace_back(name);  // packing
      at += static_cast<ssize_t>(sizeof event + event.len);
    }
    return names_;
  }

 private:
  loop::FileDescriptor inotify_;
  std::vector<std::string> names_;
};

class ReplacedMap : public testing::Test, protected MapsParts {};

TEST_F(ReplacedMap, IsMarkedBeforeTheNewerOneIsDeleted) {
  uplink::ListeningPeer peer(uplink::always(uplink::answer("200 OK", "null")));
  settings_.command_post.mapping = {peer.endpoint().address, peer.endpoint().port};
  Maps maps = maps_with(icd::BearerToken::parse("a-token"));
  rejected_.add(grid_of("r1", 10), 422, "no", 100, {});
  ASSERT_TRUE(loop::turn_until_idle(loop_, writer_));
  WatchedDirectories watched(rejected_folder_.path(), folder_.path());
  maps.accept(grid_of("r1", 20), {.bytes = 10}, nullptr, [](const icd::Checked<void>&) {});
  ASSERT_TRUE(loop::turn_until(loop_, [&] { return watched.names().size() >= 2; }));
  EXPECT_EQ(watched.names().front(), "1.json");
  EXPECT_TRUE(rejected_.rows().front().replaced);
}

}  // namespace
}  // namespace adit::forward
