#pragma once

#include <sys/eventfd.h>

#include <expected>
#include <string>

#include "loop/file_descriptor.hpp"
#include "panel/lines.hpp"

namespace adit::panel {

/// A wire whose button a test presses.
struct Wire {
  loop::FileDescriptor changed{eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)};
  bool pressed = false, broken = false;
  bool open = false;
  int looked = 0;

  void set(bool is_pressed) {
    pressed = is_pressed;
    eventfd_write(changed.get(), 1);
  }
};

class WireLine final : public ButtonLine {
 public:
  explicit WireLine(Wire& wire) : wire_(wire) { wire_.open = true; }
  WireLine(const WireLine&) = delete;
  WireLine& operator=(const WireLine&) = delete;
  ~WireLine() override { wire_.open = false; }
  int descriptor() const override { return wire_.changed.get(); }
  std::expected<bool, std::string> is_pressed() override {
    eventfd_t count = 0;
    eventfd_read(wire_.changed.get(), &count);
    ++wire_.looked;
    if (wire_.broken) return std::unexpected("gpiochip0: gone");
    return wire_.pressed;
  }

 private:
  Wire& wire_;
};

}  // namespace adit::panel
