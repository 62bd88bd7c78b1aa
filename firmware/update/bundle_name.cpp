#include "update/bundle_name.hpp"

#include <algorithm>

namespace adit::update {
namespace {

constexpr std::string_view kBegin = "adit-", kEnd = ".raucb";

}  // namespace

bool is_bundle_name(std::string_view name) {
  return name.size() >= kBegin.size() + kEnd.size() && name.starts_with(kBegin) && name.ends_with(kEnd);
}

bool is_plain(std::string_view name) {
  return std::ranges::all_of(name, [](char each) { return each >= ' ' && each <= '~'; });
}

Promise promise_of(std::string_view name, std::string_view compatible) {
  if (!name.starts_with(compatible) || !name.ends_with(kEnd)) return {};
  name.remove_prefix(compatible.size());
  if (!name.starts_with('-')) return {};
  name.remove_prefix(1);
  name.remove_suffix(std::min(kEnd.size(), name.size()));
  return {.for_this_board = true, .version = Version::parse(name)};
}

}  // namespace adit::update
