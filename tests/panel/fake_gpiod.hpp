#pragma once

#include <map>
#include <string>

namespace adit::panel {

/// What stands behind the fake libgpiod of either version (fake_gpiod1.cpp, fake_gpiod2.cpp): chips by their
/// paths, and their lines by name.
struct FakeLine {
  bool requested = false;
  bool output = false;
  bool active_low = false;
  int pull = 0;  // 1 up, -1 down
  std::string consumer;
  bool level = false;   // what the wire carries; an output keeps its last level after it is released
  int fails_with = 0;   // errno of setting or reading it
  int descriptor = -1;  // a pipe's end: readable while events wait
  int events = 0;       // how many wait
};

struct FakeChip {
  std::string name, label;
  bool knows_pull = true;
  int opens_with = 0;  // errno of opening it
  std::map<std::string, FakeLine> lines;
};

struct FakeGpio {
  std::map<std::string, FakeChip> chips;  // by path: "/dev/gpiochip0"
  int open = 0;                           // chips and requests that are not closed yet
  int lists_with = 0;                     // errno of listing the chips

  FakeLine& line(const std::string& name);
  /// The wire of an input changes, and its user is told.
  void drive(const std::string& name, bool level);
};

FakeGpio& fake_gpio();

// As libgpiod's functions, these set errno and return -1 if they fail.
/// Requests the line with the direction, polarity, pull and consumer of `as`.
int request(const FakeChip& chip, FakeLine& line, const FakeLine& as);
int set_value(FakeLine& line, bool active);
int get_value(const FakeLine& line);
int read_events(FakeLine& line, std::size_t most);

}  // namespace adit::panel
