#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "simulation/history.hpp"
#include "simulation/http.hpp"
#include "simulation/random.hpp"

namespace adit::simulation {

class World;

/// A client's use of its connections.
struct Manners {
  bool keeps_alive = true;
  double patience = 10;    // seconds to wait for an answer
  double hangs_up = 0;     // probability per request, at any byte
  double dribbles = 0.1;   // probability of a request in pieces
  double half_closes = 0;  // probability of ending its direction after the request
  double stalls = 0;       // probability of stopping within a request and holding the connection
  double pauses = 0;       // probability of waiting for 1 to 8 s within the body, after the whole head
};

/// An HTTP client of the team: one request at a time.
class Client {
 public:
  /// `world` must outlive the client.
  Client(World& world, std::string address, Manners manners, Random random);
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// Sends a request. Calls `done` with the status, or with 0 if there was no complete answer. Requires
  /// !busy().
  void ask(std::string request, Event about, std::function<void(int status)> done) {
    ask_several(std::move(request), std::vector{std::move(about)}, std::move(done));
  }
  /// The same for a request with several items, with one event for each.
  void ask_several(std::string request, std::vector<Event> about, std::function<void(int status)> done);
  /// From now on its requests are never left out, because a check counts on them.
  void is_needed() { needed_ = true; }
  bool busy() const { return static_cast<bool>(done_); }
  /// The body of the last complete answer.
  const std::string& heard() const { return heard_; }

 private:
  void connect();
  void close();
  void go_on();
  void stall();
  void write(std::size_t most);
  void ready(std::uint32_t events);
  void read();
  void heard(const HttpMessage& answer);
  void ended(Event event);
  void gone(const std::string& why);

  World& world_;
  const std::string address_;
  const Manners manners_;
  Random random_;
  int fd_ = -1;
  std::uint64_t watch_ = 0;
  HttpStream answers_;
  std::string request_;
  std::size_t written_ = 0;
  std::size_t hang_up_at_ = 0;  // bytes; 0: never
  std::size_t stalls_at_ = 0;   // bytes; 0: never
  std::size_t pauses_at_ = 0;   // bytes; 0: never
  bool half_close_ = false;
  Event about_;  // the first item of the request
  std::function<void(int)> done_;
  std::string heard_;
  std::uint64_t number_ = 0;
  bool needed_ = false;
};

}  // namespace adit::simulation
