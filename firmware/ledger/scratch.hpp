#pragma once

#include <string>

#include "loop/file_descriptor.hpp"

namespace adit::ledger {

/// A folder that goes with this; path "": none. A lock on it says that it is in use, until this ends by
/// whatever end of the program.
class Scratch {
 public:
  Scratch() = default;
  explicit Scratch(const std::string& below);
  ~Scratch();
  Scratch(Scratch&& other) noexcept;
  Scratch& operator=(Scratch&& other) noexcept;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
  loop::FileDescriptor lock_;
};

/// Removes the folders below `below` that a Scratch made and nobody uses any more.
void sweep_scratch(const std::string& below);

}  // namespace adit::ledger
