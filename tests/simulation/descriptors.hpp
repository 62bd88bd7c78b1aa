#pragma once

#include <cstdint>
#include <functional>
#include <map>

namespace adit::simulation {

/// The real descriptors: libmicrohttpd's, and the clients' ends of their connections. They are polled
/// without waiting, and called in the order in which they were added.
class Descriptors {
 public:
  Descriptors();
  ~Descriptors();
  Descriptors(const Descriptors&) = delete;
  Descriptors& operator=(const Descriptors&) = delete;

  using Ready = std::function<void(std::uint32_t)>;
  enum class Whose : std::uint8_t { Adits, Others, All };
  /// Returns the number for the other calls.
  std::uint64_t add(int fd, std::uint32_t events, Ready ready, Whose whose = Whose::Others);
  void wait_for(std::uint64_t number, std::uint32_t events);
  void remove(std::uint64_t number);
  /// Calls those that are ready. Returns false if none was.
  bool dispatch(Whose whose);

 private:
  struct Watched {
    int fd;
    Whose whose;
    bool edge;
    bool added;
    Ready ready;
  };
  int epoll_;
  std::uint64_t last_ = 0;
  std::map<std::uint64_t, Watched> watched_;
  std::map<std::uint64_t, std::uint32_t> happened_;  // events that the watcher has not seen yet
};

}  // namespace adit::simulation
