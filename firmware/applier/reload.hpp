#pragma once

#include <chrono>
#include <expected>
#include <string>

#include "applier/options.hpp"

namespace adit::applier {

/// The duty to make networkd read its files again, from before a file changes until networkd has read them. A
/// file in memory preserves it across a kill, and is lost at boot like networkd's own files.
class Reload {
 public:
  static constexpr std::chrono::seconds kWithin{30};

  /// `options` must outlive this object.
  explicit Reload(const Options& options) : options_(options) {}

  bool is_due() const;
  /// Call before a file changes. If the mark cannot be written, only a kill would lose it.
  void set_due();
  /// Reloads if due. After an error it is still due.
  std::expected<void, std::string> run();

 private:
  std::string file() const { return options_.status + "/reload-due"; }

  const Options& options_;
  bool is_due_ = false;  // as known to this process
};

}  // namespace adit::applier
