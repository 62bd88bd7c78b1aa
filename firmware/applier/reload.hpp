#pragma once

#include <chrono>
#include <expected>
#include <string>

#include "applier/options.hpp"

namespace adit::applier {

/// That networkd reads its files again: due from before they change until it has. That it is due outlives a
/// kill, in a file that goes as the machine starts, as networkd's own do.
class Reload {
 public:
  static constexpr std::chrono::seconds kWithin{30};

  /// `options` outlives this.
  explicit Reload(const Options& options) : options_(options) {}

  bool is_due() const;
  /// Before a file changes. Where it cannot be noted, only a kill would make it be forgotten.
  void set_due();
  /// Where it is due. An error: it still is.
  std::expected<void, std::string> run();

 private:
  std::string file() const { return options_.status + "/reload-due"; }

  const Options& options_;
  bool is_due_ = false;  // as this start of the program knows
};

}  // namespace adit::applier
