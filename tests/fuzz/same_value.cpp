#include "same_value.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace adit::fuzz {
namespace {

using codec::Value;
using nlohmann::json;

/// A negative integer of CBOR that is less than that nlohmann's reader turns into another.
constexpr double kLeastOfTheirs = -9223372036854775808.0;

struct Comparison {
  const json& theirs;

  bool operator()(std::nullptr_t) const { return theirs.is_null(); }
  bool operator()(bool ours) const { return theirs.is_boolean() && theirs == ours; }
  bool operator()(std::int64_t ours) const { return theirs.is_number() && theirs == ours; }
  bool operator()(std::uint64_t ours) const { return theirs.is_number() && theirs == ours; }
  bool operator()(double ours) const {
    if (!theirs.is_number()) return false;
    if (ours < kLeastOfTheirs && theirs.is_number_integer()) return true;
    const auto number = theirs.get<double>();
    return number == ours || (std::isnan(number) && std::isnan(ours));
  }
  bool operator()(const std::string& ours) const {
    return theirs.is_string() && theirs.get<std::string>() == ours;
  }
  bool operator()(const Value::Bytes& ours) const {
    return theirs.is_binary() && std::ranges::equal(theirs.get_binary(), ours.bytes);
  }
  bool operator()(Value::TaggedValue) const { return true; }  // whatever they read there
  bool operator()(Value::SplitOut) const { return false; }
  bool operator()(const Value::Array& ours) const {
    return theirs.is_array() && std::ranges::equal(ours, theirs, is_same);
  }
  bool operator()(const std::shared_ptr<const codec::List>&) const { return false; }
  bool operator()(const Value::Object& ours) const {
    if (!theirs.is_object()) return false;
    std::map<std::string, const Value*> last;
    for (const auto& [name, value] : ours) last.insert_or_assign(name, &value);
    return last.size() == theirs.size() && std::ranges::all_of(last, [this](const auto& member) {
             const auto found = theirs.find(member.first);
             return found != theirs.end() && is_same(*member.second, *found);
           });
  }
};

}  // namespace

bool is_same(const Value& ours, const json& theirs) {
  return std::visit(Comparison{theirs}, ours.is);
}

bool has_infinity(const Value& ours) {
  if (const auto* number = std::get_if<double>(&ours.is)) return std::isinf(*number);
  if (const auto* array = std::get_if<Value::Array>(&ours.is))
    return std::ranges::any_of(*array, has_infinity);
  const auto* object = std::get_if<Value::Object>(&ours.is);
  return object != nullptr && std::ranges::any_of(*object, has_infinity, &Value::Member::second);
}

}  // namespace adit::fuzz
