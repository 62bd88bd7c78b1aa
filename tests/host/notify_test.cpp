#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdlib>

#include "host/folder.hpp"
#include "host/service.hpp"

namespace adit::host {
namespace {

/// Stands for systemd: the socket that $NOTIFY_SOCKET names.
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

 private:
  Folder folder_;
  int socket_;
};

TEST_F(Notify, TellsSystemdHowTheServiceIs) {
  notify_ready("serving");
  EXPECT_EQ(heard(), "READY=1\nSTATUS=serving");
  notify_status("2 reports wait");
  EXPECT_EQ(heard(), "STATUS=2 reports wait");
  notify_stopping();
  EXPECT_EQ(heard(), "STOPPING=1");
}

TEST_F(Notify, TakesNoOrdersFromAStatus) {
  notify_status("from a client\nSTOPPING=1");
  EXPECT_EQ(heard(), "STATUS=from a client\\x0aSTOPPING=1");
}

TEST_F(Notify, SaysNothingOutsideSystemd) {
  unsetenv("NOTIFY_SOCKET");
  notify_ready("serving");
  EXPECT_EQ(heard(), "");
}

}  // namespace
}  // namespace adit::host
