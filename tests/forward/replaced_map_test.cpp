// A map that was taken, and an older one that it replaced while that was rejected: in which order a life to
// come learns of both.
#include <gtest/gtest.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "../uplink/peer.hpp"
#include "forward/around.hpp"
#include "forward/maps.hpp"
#include "loop/file_descriptor.hpp"
#include "loop/turn_until.hpp"

namespace adit::forward {
namespace {

icd::MapUpdate grid_at_stamp(std::uint32_t side, icd::Stamp stamp) {
  icd::OccupancyGrid grid;
  grid.header.stamp = stamp;
  grid.resolution = 0.25;
  grid.width = grid.height = side;
  const std::vector<std::uint8_t> cells(std::size_t{side} * side, 1);
  return {
      icd::RobotName::parse("r1"), grid, {icd::ChunkedBytes{cells}, icd::Compression::None, cells.size()}};
}

/// What happens to the names in two folders, in order.
class Watched {
 public:
  Watched(const std::string& one, const std::string& other)
      : inotify_(::inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {
    ::inotify_add_watch(inotify_.get(), one.c_str(), IN_MOVED_TO);
    ::inotify_add_watch(inotify_.get(), other.c_str(), IN_DELETE);
  }
  /// The names that were made in the one or removed from the other.
  std::vector<std::string> names() {
    alignas(inotify_event) std::array<char, 4096> read{};
    const ssize_t count = ::read(inotify_.get(), read.data(), read.size());
    for (ssize_t at = 0; at < count;) {
      inotify_event event{};
      std::memcpy(&event, read.data() + at, sizeof event);
      const std::string_view name = read.data() + at + sizeof event;
      if (name != "at-work") names_.emplace_back(name);  // the map is packed
      at += static_cast<ssize_t>(sizeof event + event.len);
    }
    return names_;
  }

 private:
  loop::FileDescriptor inotify_;
  std::vector<std::string> names_;
};

class ReplacedMap : public testing::Test, protected AroundMaps {};

TEST_F(ReplacedMap, IsKnownAsOvertakenBeforeTheNewerOneIsForgotten) {
  uplink::ListeningPeer peer([](uplink::Wire& wire) {
    while (!wire.read_request().empty()) {
      if (!wire.write(uplink::answer("200 OK", "null"))) return;
    }
  });
  settings_.command_post.mapping = {peer.endpoint().address, peer.endpoint().port};
  Maps maps(loop_, workers_, writer_, spool_, settings_, icd::BearerToken::parse("a-token"), record_,
            rejected_, random_, journal_, [](const icd::MapUpdate&) {});
  rejected_.add(grid_at_stamp(10, 1), 422, "no", 100, {});
  ASSERT_TRUE(loop::turn_until_idle(loop_, writer_));
  Watched watched(rejected_folder_.path(), folder_.path());
  maps.take(grid_at_stamp(20, 2), 10, nullptr, [](const icd::Checked<void>&) {});
  ASSERT_TRUE(loop::turn_until(loop_, [&] { return watched.names().size() >= 2; }));
  EXPECT_EQ(watched.names().front(), "1.json");
  EXPECT_TRUE(rejected_.rows().front().replaced);
}

}  // namespace
}  // namespace adit::forward
