#pragma once

#include <array>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <type_traits>

#include "intake/server.hpp"
#include "loop/loop.hpp"
#include "loop/turn_until.hpp"
#include "patience.hpp"

namespace adit::intake {

/// A Server on a loop in its own thread.
class Served {
 public:
  explicit Served(Handler& handler, Listen listen = {}) {
    if (listen.address.empty()) listen.address = "127.0.0.1";
    listen.on_ended = [this](CloseReason why, const std::string&) {
      ++ended_[static_cast<std::size_t>(why)];
    };
    std::promise<void> started;
    thread_ = std::thread([this, &started, &handler, listen] {
      loop_ = std::make_unique<loop::Loop>();
      auto server = Server::start(*loop_, listen, handler);
      if (server) {
        server_ = std::move(*server);
        port_ = server_->port();
      } else {
        error_ = server.error();
      }
      started.set_value();
      loop_->run();
      server_ = nullptr;
    });
    started.get_future().wait();
  }
  Served(const Served&) = delete;
  Served& operator=(const Served&) = delete;
  ~Served() { stop(); }

  void stop() {
    if (!thread_.joinable()) return;
    loop_->post([this] { loop_->stop(); });
    thread_.join();
  }

  /// Runs `task` on the loop's thread and returns its result.
  template <class Task>
  auto on_loop(Task task) {
    std::promise<std::invoke_result_t<Task>> done;
    loop_->post([&] {
      if constexpr (std::is_void_v<std::invoke_result_t<Task>>) {
        task();
        done.set_value();
      } else {
        done.set_value(task());
      }
    });
    return done.get_future().get();
  }

  /// Waits until `condition` holds. It is called on the loop's thread.
  template <class Condition>
  bool eventually(Condition condition, std::chrono::milliseconds within = std::chrono::seconds(10)) {
    const auto until = loop::kernel_now() + patient(within);
    while (!on_loop(condition)) {
      if (loop::kernel_now() > until) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return true;
  }

  /// Turns the loop until it has seen all earlier input. A turn reads one piece of each connection.
  void turn_often() {
    for (int i = 0; i < 100; ++i) on_loop([] {});
  }

  /// Connections that the server ended for this reason.
  std::uint64_t ended(CloseReason why) {
    return on_loop([&] { return ended_[static_cast<std::size_t>(why)]; });
  }

  std::uint16_t port() const { return port_; }
  const std::string& error() const { return error_; }
  loop::Loop& loop() { return *loop_; }
  Server& server() { return *server_; }
  /// Call on the loop's thread.
  void destroy_server() { server_ = nullptr; }

 private:
  std::array<std::uint64_t, kEndedKinds> ended_{};
  std::unique_ptr<loop::Loop> loop_;
  std::unique_ptr<Server> server_;
  std::uint16_t port_ = 0;
  std::string error_;
  std::thread thread_;
};

}  // namespace adit::intake
