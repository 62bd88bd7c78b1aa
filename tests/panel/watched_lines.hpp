#pragma once

#include <expected>
#include <string>
#include <vector>

#include "panel/lines.hpp"

namespace adit::panel {

/// Lines that record their lights, and fail if the test says so.
class WatchedLines final : public Lines {
 public:
  struct Seen {
    std::vector<Lit> shown;
    bool fail = false;
    bool is_watched = false;
  };
  explicit WatchedLines(Seen& seen) : seen_(seen) {}
  std::expected<void, std::string> set(const Lit& lit) override {
    seen_.shown.push_back(lit);
    if (seen_.fail) return std::unexpected("gpiochip0: gone");
    return {};
  }
  bool is_watched() const override { return seen_.is_watched; }

 private:
  Seen& seen_;
};

}  // namespace adit::panel
