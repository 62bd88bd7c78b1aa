#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <cstring>

#include "host/folder.hpp"
#include "host/systemd.hpp"

namespace adit::host {
namespace {

/// Replaces systemd: listens on the socket in $NOTIFY_SOCKET.
class Notify : public testing::Test {
 protected:
  Notify() : socket_(socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    const std::string path = folder_ / "notify";
    path.copy(name.sun_path, sizeof name.sun_path - 1);
    EXPECT_EQ(bind(socket_, reinterpret_cast<const sockaddr*>(&name), sizeof name), 0);
    setenv("NOTIFY_SOCKET", path.c_str(), 1);
  }
  ~Notify() override {
    unsetenv("NOTIFY_SOCKET");
    close(socket_);
  }
  std::string heard() const {
    char text[512];
    const ssize_t size = recv(socket_, text, sizeof text, 0);
    return size < 0 ? "" : std::string(text, static_cast<std::size_t>(size));
  }

  Folder folder_;
  int socket_;
};

TEST_F(Notify, SendsTheStateToSystemd) {
  notify_ready("serving");
  EXPECT_EQ(heard(), "READY=1\nSTATUS=serving");
  notify_status("2 reports wait");
  EXPECT_EQ(heard(), "STATUS=2 reports wait");
  notify_alive();
  EXPECT_EQ(heard(), "WATCHDOG=1");
  notify_stopping();
  EXPECT_EQ(heard(), "STOPPING=1");
  notify_restarting();
  EXPECT_EQ(heard(), "") << "no watchdog";
  setenv("WATCHDOG_USEC", "10000000", 1);
  notify_restarting();
  EXPECT_EQ(heard(), "WATCHDOG_USEC=60000000");
  notify_ready("serving");
  EXPECT_EQ(heard() + heard(), "READY=1\nSTATUS=servingWATCHDOG_USEC=10000000");
  unsetenv("WATCHDOG_USEC");
}

TEST_F(Notify, EscapesAStatus) {
  notify_status("from a client\nSTOPPING=1");
  EXPECT_EQ(heard(), "STATUS=from a client\\x0aSTOPPING=1");
}

TEST_F(Notify, StoresDescriptorsByName) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  store_descriptor("listen-team0-10.0.0.1-8000", ends[1]);
  close(ends[1]);
  char text[64];
  iovec piece{text, sizeof text};
  alignas(cmsghdr) char ancillary[CMSG_SPACE(sizeof(int))];
  msghdr message{};
  message.msg_iov = &piece;
  message.msg_iovlen = 1;
  message.msg_control = ancillary;
  message.msg_controllen = sizeof ancillary;
  const ssize_t size = recvmsg(socket_, &message, 0);
  ASSERT_GT(size, 0);
  EXPECT_EQ(std::string(text, static_cast<std::size_t>(size)),
            "FDSTORE=1\nFDNAME=listen-team0-10.0.0.1-8000");
  const cmsghdr* given = CMSG_FIRSTHDR(&message);
  ASSERT_NE(given, nullptr);
  ASSERT_EQ(given->cmsg_type, SCM_RIGHTS);
  int kept = -1;
  std::memcpy(&kept, CMSG_DATA(given), sizeof kept);
  EXPECT_EQ(write(kept, "x", 1), 1) << "the pipe's writing end";
  EXPECT_EQ(read(ends[0], text, sizeof text), 1);
  close(kept);
  close(ends[0]);
  forget_descriptor("listen-team0-10.0.0.1-8000");
  EXPECT_EQ(heard(), "FDSTOREREMOVE=1\nFDNAME=listen-team0-10.0.0.1-8000");
}

TEST(InheritedDescriptors, IsEmptyOutsideSystemdOrForAnotherProcess) {
  EXPECT_TRUE(inherited_sockets().value().empty());
  setenv("LISTEN_FDS", "1", 1);
  setenv("LISTEN_PID", "1", 1);
  EXPECT_TRUE(inherited_sockets().value().empty());
  setenv("LISTEN_PID", std::to_string(getpid()).c_str(), 1);
  setenv("LISTEN_FDS", "many", 1);
  EXPECT_FALSE(inherited_sockets());
  EXPECT_EQ(getenv("LISTEN_FDS"), nullptr) << "a child process would use the variable";
}

TEST(WatchdogWithin, IsTheValueOfSystemd) {
  unsetenv("WATCHDOG_USEC");
  EXPECT_EQ(watchdog_interval(), std::nullopt);
  setenv("WATCHDOG_USEC", "10000000", 1);
  EXPECT_EQ(watchdog_interval(), std::chrono::seconds(10));
  setenv("WATCHDOG_PID", "1", 1);
  EXPECT_EQ(watchdog_interval(), std::nullopt) << "the watchdog is another process's";
  unsetenv("WATCHDOG_USEC");
  unsetenv("WATCHDOG_PID");
}

TEST_F(Notify, SendsNothingOutsideSystemd) {
  unsetenv("NOTIFY_SOCKET");
  notify_ready("serving");
  EXPECT_EQ(heard(), "");
}

}  // namespace
}  // namespace adit::host
