#pragma once

#include <expected>
#include <string>
#include <utility>

namespace adit::applier {

/// What one of these programs tells everybody.
class StatusFile {
 public:
  explicit StatusFile(std::string path) : path_(std::move(path)) {}

  /// Writes it, where it is another text than was told last. Whether it was; what hinders it is logged, and
  /// is an error.
  std::expected<bool, std::string> tell(std::string text);

 private:
  std::string path_, told_;
};

}  // namespace adit::applier
