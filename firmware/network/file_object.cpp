#include "network/file_object.hpp"

#include <algorithm>
#include <cstdint>

#include "icd/sentence.hpp"

namespace adit::network::file_object {
namespace {

using codec::Field;
using codec::Value;

constexpr std::int64_t kFormat = 1;  // of all of them, so far

}  // namespace

std::string written(std::string_view format, Value::Object members) {
  members.insert(members.begin(), {std::string(format), {kFormat}});
  return codec::write_json({std::move(members)}) + '\n';
}

void only(const Field& object, std::initializer_list<std::string_view> names, std::string_view besides) {
  const auto* members = object.value() == nullptr ? nullptr : std::get_if<Value::Object>(&object.value()->is);
  if (members == nullptr) return object.refuse_kind("an object");
  for (const auto& [name, value] : *members) {
    if (name != besides && std::ranges::find(names, name) == names.end())
      object.refuse("no such member: ", icd::in_quotes(name));
  }
}

void expect_format(const Field& object, std::string_view format) {
  object.member(format).whole<std::int64_t>(kFormat, kFormat);
}

std::string text(const Field& object, std::string_view name) {
  return std::string(object.member(name).text());
}

}  // namespace adit::network::file_object
