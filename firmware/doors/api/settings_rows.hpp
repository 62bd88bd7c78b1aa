#pragma once

#include <optional>
#include <string>
#include <vector>

#include "api/setup.hpp"
#include "codec/row.hpp"
#include "settings/written.hpp"

namespace adit::api {

/// Data about one settings key, for a form.
struct KeyRow {
  std::string path, meaning, kind;
  bool required = false;
  codec::Value default_value;
  std::string range;
  std::optional<std::vector<std::string>> words = std::nullopt;  // of a choice
  codec::Value least = {}, most = {};                            // of a number

  static const codec::Row kRow;
};

/// The settings and tokens in use, and the data for their form.
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

/// The changes.
struct ChangesView {
  std::vector<settings::Change> changes;
  std::vector<std::string> warnings;

  static const codec::Row kRow;
};

/// The effect of a change of the settings or the box's addresses, or its errors.
struct CheckView {
  std::vector<settings::Error> errors;
  ChangesView changes;

  static const codec::Row kRow;
};

/// All keys, in table order.
std::vector<KeyRow> key_rows();

SetupView setup_view(const Setup& setup);

}  // namespace adit::api
