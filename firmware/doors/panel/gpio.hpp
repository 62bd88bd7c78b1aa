#pragma once

#include <expected>
#include <memory>
#include <string>

namespace adit::panel {

/// A line to request with libgpiod.
struct GpioRequest {
  std::string chip;      // name, label or path; empty: any chip
  std::string line;      // name
  std::string about;     // the line in an error: "line H (health) of chip gpiochip0"
  std::string consumer;  // as gpioinfo(1) shows it
  bool active_low = false;
  /// Inactive at first. An input reports both edges, and is pulled to inactive if the chip can.
  bool is_output = false;
};

/// A requested line, released when it is destroyed. A function that fails sets errno and returns -1.
class GpioLine {
 public:
  virtual ~GpioLine() = default;
  virtual int set(bool active) = 0;
  /// 1 if the line is active, else 0.
  virtual int get() = 0;
  /// Readable while edges are reported. Owned by this object.
  virtual int descriptor() const = 0;
  /// Drops all reported edges.
  virtual int drop_edges() = 0;
};

/// gpiod1.cpp and gpiod2.cpp define this, each with its version of libgpiod.
std::expected<std::unique_ptr<GpioLine>, std::string> request_line(const GpioRequest& wanted);

}  // namespace adit::panel
