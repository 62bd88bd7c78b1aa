#include <sys/epoll.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <optional>
#include <system_error>
#include <utility>

#include "loop/file_descriptor.hpp"
#include "panel/messages.hpp"
#include "panel/reopened.hpp"

namespace adit::panel {
namespace {

using Clock = std::chrono::steady_clock;
// Unanswered for this long is an error. adit-panel may start later than aditd, and may be restarted.
constexpr std::chrono::seconds kPatience{30};
constexpr int kMessagesAtOnce = 64;

std::string unreachable(const std::string& socket, int error) {
  return "adit-panel does not answer at " + socket + ": " + std::system_category().message(error);
}

/// The connection that lights and button share.
class Connection {
 public:
  Connection(std::string socket, std::string greeting, loop::FileDescriptor epoll,
             loop::FileDescriptor announced)
      : socket_(std::move(socket)), greeting_(std::move(greeting)), epoll_(std::move(epoll)) {
    if (announced) attach(std::move(announced));
  }

  std::expected<void, std::string> send_message(const std::string& message) {
    if ((fd_ || attach(connected_to(socket_))) && put(message)) {
      unheard_since_.reset();
      return {};
    }
    const int error = errno;
    if (error != EAGAIN) disconnect();
    const auto now = Clock::now();
    if (now - unheard_since_.value_or(now) < kPatience) {
      unheard_since_ = unheard_since_.value_or(now);
      return {};
    }
    return std::unexpected(unreachable(socket_, error));
  }

  /// The last report of adit-panel.
  std::expected<void, std::string> lights() const {
    if (trouble_.empty()) return {};
    return std::unexpected(trouble_);
  }

  std::expected<bool, std::string> is_pressed() {
    std::array<char, kLongestMessage> bytes{};
    for (int i = 0; fd_ && i < kMessagesAtOnce; ++i) {
      const ssize_t size = recv(fd_.get(), bytes.data(), bytes.size(), MSG_DONTWAIT);
      if (size < 0 && (errno == EAGAIN || errno == EINTR)) break;
      if (size <= 0) {
        disconnect();
        break;
      }
      if (const auto said = parse_report({bytes.data(), static_cast<std::size_t>(size)}))
        std::visit([this](const auto& each) { handle(each); }, *said);
    }
    if (std::exchange(was_lost_, false) || !pressed_)
      return std::unexpected("adit-panel cannot read the button");
    return *pressed_;
  }

  /// Stays the same across connections: readable if the present one is.
  int descriptor() const { return epoll_.get(); }

 private:
  void handle(const ButtonState& said) {
    pressed_ = said.pressed;
    if (!pressed_) was_lost_ = true;
  }
  void handle(const LightsState& said) { trouble_ = said.trouble; }

  /// False with errno, also if `fd` is empty.
  bool attach(loop::FileDescriptor fd) {
    epoll_event wanted{.events = EPOLLIN, .data = {}};
    if (!fd || epoll_ctl(epoll_.get(), EPOLL_CTL_ADD, fd.get(), &wanted) != 0) return false;
    fd_ = std::move(fd);
    return put(greeting_);
  }

  bool put(const std::string& message) {
    return send(fd_.get(), message.data(), message.size(), MSG_DONTWAIT | MSG_NOSIGNAL) >= 0;
  }

  void disconnect() {
    fd_ = loop::FileDescriptor();  // also removes it from the epoll
    if (pressed_.value_or(false)) was_lost_ = true;
    pressed_ = false;
    trouble_.clear();
  }

  std::string socket_, greeting_;
  loop::FileDescriptor epoll_, fd_;
  std::optional<Clock::time_point> unheard_since_;
  std::optional<bool> pressed_ = false;  // nullopt: it cannot be read
  bool was_lost_ = false;                // a press was cancelled since the last call of is_pressed()
  std::string trouble_;                  // with the lights
};

class RemoteLines final : public Lines {
 public:
  explicit RemoteLines(std::shared_ptr<Connection> connection) : connection_(std::move(connection)) {}
  RemoteLines(const RemoteLines&) = delete;
  RemoteLines& operator=(const RemoteLines&) = delete;
  /// Sends the end only after a first set(): a program that ends before has failed to start.
  ~RemoteLines() override {
    if (is_started_) [[maybe_unused]]
      const auto told = connection_->send_message(message_of(EndRequest{}));
  }

  std::expected<void, std::string> set(const Lit& lit) override {
    is_started_ = true;
    if (auto told = connection_->send_message(message_of(LightRequest{lit})); !told) return told;
    return connection_->lights();
  }
  bool is_watched() const override { return true; }

 private:
  std::shared_ptr<Connection> connection_;
  bool is_started_ = false;
};

class RemoteButton final : public ButtonLine {
 public:
  explicit RemoteButton(std::shared_ptr<Connection> connection) : connection_(std::move(connection)) {}
  int descriptor() const override { return connection_->descriptor(); }
  std::expected<bool, std::string> is_pressed() override { return connection_->is_pressed(); }

 private:
  std::shared_ptr<Connection> connection_;
};

}  // namespace

loop::FileDescriptor announce(const std::string& socket) {
  return connected_to(socket);
}

std::expected<PanelDevices, std::string> remote(const std::string& socket, const settings::Panel& settings,
                                                loop::FileDescriptor announced) {
  loop::FileDescriptor epoll(epoll_create1(EPOLL_CLOEXEC));
  if (!epoll) return std::unexpected(unreachable(socket, errno));
  auto connection = std::make_shared<Connection>(socket, message_of(LinesRequest{settings}), std::move(epoll),
                                                 std::move(announced));
  return PanelDevices{std::make_unique<RemoteLines>(connection), std::make_unique<RemoteButton>(connection)};
}

}  // namespace adit::panel
