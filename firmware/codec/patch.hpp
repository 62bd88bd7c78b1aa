#pragma once

#include <optional>

#include "codec/row.hpp"
#include "codec/value.hpp"

namespace adit::codec {

/// What `before` becomes `now` by, or nothing where they are the same. Both are of `row`, as write_row()
/// writes them.
///
/// A JSON merge patch (RFC 7396), but for two things. A null says that the value is null, for the members of
/// a row never go; one that went all the same is null. And a list of rows is patched by places, by an object:
/// - `length`: how many there are, where that is another number;
/// - `kept`: [to, from, count]: which rows moved with their neighbours from which place; left out where none
///   moved. Where it is there, all that it does not name is new;
/// - `rows`: by their places, the patches of those that changed, and the new ones whole.
/// Which row is the same, the row's `id` says. Names in a patch are those of members and places alone: what
/// somebody typed is always a value.
std::optional<Value> patch(const Row& row, const Value& before, const Value& now);

}  // namespace adit::codec
