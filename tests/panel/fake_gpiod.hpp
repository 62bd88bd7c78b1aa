#pragma once

#include <map>
#include <string>

namespace adit::panel {

/// The state behind the fake libgpiod of both versions (fake_gpiod1.cpp, fake_gpiod2.cpp): chips by path,
/// and lines by name.
struct FakeLine {
  bool requested = false;
  bool output = false;
  bool active_low = false;
  int pull = 0;  // 1 up, -1 down
  std::string consumer;
  bool level = false;   // level of the wire; an output keeps its last level after its release
  int fails_with = 0;   // errno of setting or reading it
  int descriptor = -1;  // a pipe's end: readable while events are queued
  int events = 0;       // number of queued events
};

struct FakeChip {
  std::string name, label;
  bool knows_pull = true;
  int opens_with = 0;  // errno of opening it
  std::map<std::string, FakeLine> lines;
};

struct FakeGpio {
  std::map<std::string, FakeChip> chips;  // by path: "/dev/gpiochip0"
  int open = 0;                           // chips and requests that are still open
  int lists_with = 0;                     // errno of listing the chips

  FakeLine& line(const std::string& name);
  /// Changes the level of an input and queues an event.
  void drive(const std::string& name, bool level);
};

FakeGpio& fake_gpio();

// Like libgpiod's functions, these set errno and return -1 on failure.
/// Requests the line with the direction, polarity, pull and consumer of `as`.
int request(const FakeChip& chip, FakeLine& line, const FakeLine& as);
int set_value(FakeLine& line, bool active);
int get_value(const FakeLine& line);
int read_events(FakeLine& line, std::size_t most);

}  // namespace adit::panel
