#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace adit::journal {

/// What a record tells. The numbers are in files: they stay.
enum class Kind : std::uint8_t {
  Clock = 1,         // the start of the machine, an instant and the stamp of that instant
  LifeBegins = 2,    // what was under way in the life before came to nothing, as far as anybody knows
  Sender = 18,       // a sender's clock
  StateSent = 5,     // these robots' poses are under way
  StateDone = 6,     // what was under way needs no more care
  StateBack = 7,     // it waits again
  Markers = 9,       // a /markers/update was accepted
  MarkersSent = 10,  // these are under way, and wait no more
  MarkersDone = 11,
  MarkersBack = 12,
  Pace = 13,   // when a URI may be asked next, and what spacing was learned
  Stamp = 14,  // the last stamp of a URI
  Grids = 16,  // where grids of a name were posted
  Poses = 19,  // of a /state/update that was accepted
  Heard = 20,  // when a robot was heard, and how often it posts
};

/// Puts numbers and texts one after the other, little-endian.
class Writer {
 public:
  Writer& number(std::uint64_t number);
  Writer& real(double real);
  Writer& text(std::string_view text);
  std::string finish() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

/// Reads what a Writer wrote. What is not there reads as 0, and ok() is false.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : left_(bytes) {}
  std::uint64_t number();
  double real();
  std::string_view text();
  bool ok() const { return ok_; }
  bool at_end() const { return left_.empty(); }

 private:
  std::string_view take(std::size_t size);

  std::string_view left_;
  bool ok_ = true;
};

}  // namespace adit::journal
