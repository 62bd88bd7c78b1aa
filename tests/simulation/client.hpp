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

/// How a client treats its connections.
struct Manners {
  bool keeps_alive = true;
  double patience = 10;    // seconds for an answer
  double hangs_up = 0;     // how likely at any byte, for each request
  double dribbles = 0.1;   // how likely it sends a request in pieces
  double half_closes = 0;  // how likely it ends its direction once the request is sent
  double stalls = 0;       // how likely it stops within a request, and stays
};

/// An HTTP client of the team: one request at a time.
class Client {
 public:
  /// `world` outlives this.
  Client(World& world, std::string address, Manners manners, Random random);
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// `done` gets the status, or 0 where there was no whole answer. Requires !busy().
  void ask(std::string request, Event about, std::function<void(int status)> done) {
    ask_several(std::move(request), std::vector{std::move(about)}, std::move(done));
  }
  /// For a request that says several things: an event for each.
  void ask_several(std::string request, std::vector<Event> about, std::function<void(int status)> done);
  /// From now on all that it asks is asked: a check counts on it.
  void is_needed() { needed_ = true; }
  bool busy() const { return static_cast<bool>(done_); }
  /// The body of the last whole answer.
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
  std::size_t hang_up_at_ = 0;  // bytes; 0: not
  std::size_t stalls_at_ = 0;   // as hang_up_at_
  bool half_close_ = false;
  Event about_;  // the first of what the request says
  std::function<void(int)> done_;
  std::string heard_;
  std::uint64_t number_ = 0;  // of the request
  bool needed_ = false;
};

}  // namespace adit::simulation
