#include <gtest/gtest.h>
#include <net/if.h>
#include <netinet/in.h>
#include <poll.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>

#include "host/interfaces.hpp"

namespace adit::host {
namespace {

constexpr int kNoNamespace = 77;

void set_loopback_up() {
  const loop::FileDescriptor any(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  ifreq request{};
  std::strcpy(request.ifr_name, "lo");
  request.ifr_flags = IFF_UP;
  ioctl(any.get(), SIOCSIFFLAGS, &request);
}

bool is_told(const loop::FileDescriptor& changes, int within_ms) {
  pollfd wait{.fd = changes.get(), .events = POLLIN, .revents = 0};
  return poll(&wait, 1, within_ms) == 1;
}

/// Runs in a network namespace whose one interface is down at first. Returns the failed step; 0: success.
int tell_of_the_loopback() {
  if (unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) return kNoNamespace;
  const loop::FileDescriptor changes = link_changes();
  if (!changes) return 1;
  if (is_told(changes, 0)) return 2;
  set_loopback_up();
  if (!is_told(changes, 30'000)) return 3;
  if (!take_link_changes(changes)) return 4;
  if (is_told(changes, 0)) return 5;
  return 0;
}

void give_loopback_another_address() {
  const loop::FileDescriptor any(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  ifreq request{};
  std::strcpy(request.ifr_name, "lo");
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(0x7f000002);
  std::memcpy(&request.ifr_addr, &address, sizeof address);
  ioctl(any.get(), SIOCSIFADDR, &request);
}

int tell_of_its_address() {
  if (unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) return kNoNamespace;
  set_loopback_up();
  const loop::FileDescriptor links = link_changes(), addresses = link_and_address_changes();
  if (!links || !addresses) return 1;
  give_loopback_another_address();
  if (!is_told(addresses, 30'000)) return 2;
  return is_told(links, 0) ? 3 : 0;
}

void try_in_a_child(int (*what)()) {
  const pid_t child = fork();
  if (child == 0) _exit(what());
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  if (WEXITSTATUS(status) == kNoNamespace) GTEST_SKIP() << "no network of one's own here";
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST(LinkChanges, AreReceivedFromTheKernel) {
  try_in_a_child(tell_of_the_loopback);
}

TEST(LinkChanges, OfAddressesAreReceivedOnRequest) {
  try_in_a_child(tell_of_its_address);
}

TEST(LinkChanges, RejectADescriptorThatIsNoSocket) {
  EXPECT_FALSE(take_link_changes({}));
}

}  // namespace
}  // namespace adit::host
