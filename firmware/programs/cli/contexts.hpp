#pragma once

#include <expected>
#include <string>
#include <vector>

#include "codec/row.hpp"

namespace adit::cli {

/// An Adit that `adit login` saved.
struct Context {
  std::string name;   // "adit.local"
  std::string at;     // as typed: "adit.local:8000"
  std::string token;  // never printed

  static const codec::Row kRow;
};

/// The user's contexts, in a file that this user alone can read.
struct Contexts {
  std::string current;  // name of the context in use; "": none
  std::vector<Context> all;

  static const codec::Row kRow;

  /// Null if there is none.
  const Context* find(const std::string& name) const;
};

/// The environment variable's value, or "".
std::string variable(const char* name);

/// "$XDG_CONFIG_HOME/adit/contexts.json", or below ~/.config (XDG Base Directory Specification 0.8); "" if
/// neither HOME nor XDG_CONFIG_HOME is set.
std::string contexts_file();
/// None if the file does not exist. An error names the file, never a token.
std::expected<Contexts, std::string> load_contexts(const std::string& file);
/// Replaces the file, with mode 0600, in a directory of mode 0700.
std::expected<void, std::string> save(const Contexts& contexts, const std::string& file);

}  // namespace adit::cli
