#pragma once

#include <optional>
#include <string>
#include <vector>

#include "api/setup.hpp"
#include "codec/row.hpp"
#include "settings/written.hpp"

namespace adit::api {

/// What a form needs to know of one key of the settings.
struct KeyRow {
  std::string path, meaning, kind;
  bool required = false;
  codec::Value default_value;
  std::string range;
  std::optional<std::vector<std::string>> words = std::nullopt;  // of a choice
  codec::Value least = {}, most = {};                            // of a number

  static const codec::Row kRow;
};

/// The settings and tokens that the box runs with, and what a form needs for them.
struct SetupView {
  codec::Value settings;
  std::string tag;
  bool saved = false, applying = false;
  std::string trouble;
  std::vector<TokenRow> tokens;
  std::vector<settings::Error> odd_tokens = {};
  std::vector<KeyRow> keys = {};

  static const codec::Row kRow;
};

/// What was changed.
struct ChangesView {
  std::vector<settings::Change> changes;
  std::vector<std::string> warnings;

  static const codec::Row kRow;
};

/// What a change would be, of the settings or of the box's own addresses, or what is wrong with it.
struct CheckView {
  std::vector<settings::Error> errors;
  ChangesView changes;

  static const codec::Row kRow;
};

/// Of all keys, in the order of their table.
std::vector<KeyRow> key_rows();

SetupView setup_view(const Setup& setup);

}  // namespace adit::api
