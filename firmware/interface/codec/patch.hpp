#pragma once

#include <optional>

#include "codec/row.hpp"
#include "codec/value.hpp"

namespace adit::codec {

/// The patch from `before` to `now`, both structs of `row`: only differences. std::nullopt: written alike.
///
/// A JSON merge patch (RFC 7396) with two exceptions. A null is a value, because members of a row are never
/// removed; a missing one is null. A list of rows is patched by places, with an object:
/// - `length`: the new number of rows, if changed;
/// - `kept`: [to, from, count]: runs of rows that moved; absent: none moved. If present, other rows are new;
/// - `rows`: by place, patches of changed rows, and new rows whole.
/// The row's `id` identifies it. Names in a patch are only members and places; users' text is always a value.
std::optional<Value> patch(const Row& row, const void* before, const void* now);

/// The same for structs with a row of their own.
template <class T>
  requires requires { T::kRow; }
std::optional<Value> patch(const T& before, const T& now) {
  return patch(T::kRow, &before, &now);
}

/// Applies a patch. std::nullopt: not one of `before`. Any peer may send both; the result's size is limited.
std::optional<Value> apply_patch(Value before, const Value& patch);

}  // namespace adit::codec
