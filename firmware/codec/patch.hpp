#pragma once

#include <optional>

#include "codec/row.hpp"
#include "codec/value.hpp"

namespace adit::codec {

/// What `before` becomes `now` by, or nothing where they are written the same. Both are structs of `row`;
/// only what differs is written.
///
/// A JSON merge patch (RFC 7396), but for two things. A null says that the value is null, for the members of
/// a row never go; one that went all the same is null. And a list of rows is patched by places, by an object:
/// - `length`: how many there are, where that is another number;
/// - `kept`: [to, from, count]: which rows moved with their neighbours from which place; left out where none
///   moved. Where it is there, all that it does not name is new;
/// - `rows`: by their places, the patches of those that changed, and the new ones whole.
/// Which row is the same, the row's `id` says. Names in a patch are those of members and places alone: what
/// somebody typed is always a value.
std::optional<Value> patch(const Row& row, const void* before, const void* now);

/// The same for structs that say themselves what row they are.
template <class T>
  requires requires { T::kRow; }
std::optional<Value> patch(const T& before, const T& now) {
  return patch(T::kRow, &before, &now);
}

}  // namespace adit::codec
