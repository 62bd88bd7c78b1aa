#pragma once

#include <string>
#include <vector>

#include "api/setup.hpp"
#include "codec/row.hpp"
#include "settings/keys.hpp"
#include "settings/written.hpp"

namespace adit::api {

using KeyRow = settings::Key;
extern const codec::Row kKeyRow;

}  // namespace adit::api

namespace adit::codec {

template <>
struct KindOf<api::KeyRow> : KindOfRow<api::KeyRow, api::kKeyRow> {};

}  // namespace adit::codec

namespace adit::api {

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

SetupView setup_view(const Setup& setup);

}  // namespace adit::api
