#include "codec/field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "codec/utf8.hpp"
#include "codec/value.hpp"
#include "icd/require.hpp"

namespace adit::codec {
namespace {

/// The value as int64, if it is a whole number in range.
std::optional<std::int64_t> integer_of(const Value& value) {
  if (const auto* given = std::get_if<std::int64_t>(&value.is)) return *given;
  if (const auto* given = std::get_if<std::uint64_t>(&value.is)) {
    if (*given > std::uint64_t{std::numeric_limits<std::int64_t>::max()}) return std::nullopt;
    return static_cast<std::int64_t>(*given);
  }
  const auto* given = std::get_if<double>(&value.is);
  constexpr double kEnd = 0x1p63;
  if (!given || std::trunc(*given) != *given) return std::nullopt;  // also rejects NaN
  if (*given < -kEnd || *given >= kEnd) return std::nullopt;
  return static_cast<std::int64_t>(*given);
}

std::optional<double> number_of(const Value& value) {
  if (const auto* given = std::get_if<double>(&value.is)) return *given;
  if (const auto* given = std::get_if<std::int64_t>(&value.is)) return static_cast<double>(*given);
  if (const auto* given = std::get_if<std::uint64_t>(&value.is)) return static_cast<double>(*given);
  return std::nullopt;
}

/// A value for a sentence: a number itself, otherwise its kind.
std::string describe_value(const Value& value) {
  if (const auto* given = std::get_if<std::int64_t>(&value.is)) return std::to_string(*given);
  if (const auto* given = std::get_if<std::uint64_t>(&value.is)) return std::to_string(*given);
  if (const auto* given = std::get_if<double>(&value.is)) return icd::number_text(*given);
  return value.kind();
}

/// Forms of a time in ROS 1, ROS 2 and some C++ code, told apart by the nanoseconds' name.
struct TimeNames {
  std::string_view seconds, nanoseconds;
};
constexpr TimeNames kTimeNames[] = {{"secs", "nsecs"}, {"sec", "nanosec"}, {"sec", "nsec"}};
constexpr std::string_view kTimes = "{secs, nsecs}, {sec, nanosec} or {sec, nsec}";

/// A member that clients put in a wrong place, and its likely place beside the missing one.
struct MisplacedMember {
  std::string_view missing, found, advice;
};
constexpr MisplacedMember kMisplaced[] = {
    {"msg", "info", "put header, info and data into msg"},
    {"msg", "fields", "put header, fields, point_step and data into msg"},
    {"position", "pose", "put the pose's position and orientation here"},
    {"orientation", "pose", "put the pose's position and orientation here"},
    {"poses", "pose", "expected a list of robots, each with name, position and orientation"},
    {"x", "position", "put the position's x, y and z here"},
};

/// The longest list of missing members in a sentence.
constexpr std::size_t kMostMissing = 8;

/// A hint that the number has another unit, or "". It expects seconds of the years 2001 to 2106.
std::string unit_hint(double given, double most) {
  constexpr std::pair<double, std::string_view> kUnits[] = {{1e3, "milliseconds: divide by 1,000"},
                                                            {1e6, "microseconds: divide by 1,000,000"},
                                                            {1e9, "nanoseconds: divide by 1,000,000,000"}};
  constexpr double kLeast = 1e9;
  for (const auto& [factor, words] : kUnits) {
    if (given >= kLeast * factor && given <= most * factor)
      return icd::sentence(" (this looks like ", words, ")");
  }
  return "";
}

std::string limits(double least, double most) {
  if (std::isinf(least)) return "a finite number";
  return icd::sentence("a number from ", least, " to ", most);
}

}  // namespace

void Reading::miss(const std::string& path, std::string_view hint) {
  if (has_refusal() && missing_.empty()) return;
  if (missing_.size() == kMostMissing || std::ranges::find(missing_, path) != missing_.end()) return;
  missing_.push_back(path);
  if (hint_.empty()) hint_ = hint;
  std::string all = missing_.front();
  for (std::size_t i = 1; i < missing_.size(); ++i) all += ", " + missing_[i];
  refusal_ = icd::unprocessable(all, ": missing", hint_).error();
}

const Value::Object* Field::object() const {
  if (is<Value::Object>()) return &std::get<Value::Object>(value_->is);
  refuse_kind("an object");
  return nullptr;
}

Field Field::member(std::string_view name) const& {
  const Value* found = nullptr;
  if (const auto* members = object()) {
    for (const auto& [key, value] : *members) {
      if (key != name) continue;
      if (found) {
        Field(found, this, name, 0, reading_).refuse("given twice");
        break;
      }
      found = &value;
    }
  }
  return {found, this, name, 0, reading_};
}

std::size_t Field::size() const {
  if (is<Value::Array>()) return std::get<Value::Array>(value_->is).size();
  if (is<std::shared_ptr<const List>>()) return std::get<std::shared_ptr<const List>>(value_->is)->size();
  refuse_kind("an array");
  return 0;
}

Field Field::element(std::size_t index, Reading& reading) const& {
  if (is<std::shared_ptr<const List>>()) {
    auto parsed = std::get<std::shared_ptr<const List>>(value_->is)->element(index);
    if (parsed) return {std::make_unique<const Value>(*std::move(parsed)), this, index, reading};
    Field(nullptr, this, {}, index, reading).refuse(parsed.error().sentence);
    return {nullptr, this, {}, index, reading};
  }
  icd::require(is<Value::Array>() && index < std::get<Value::Array>(value_->is).size());
  return {&std::get<Value::Array>(value_->is)[index], this, {}, index, reading};
}

bool Field::reals(std::size_t index, std::span<const std::string_view> names, std::span<double> into) const {
  if (!is<std::shared_ptr<const List>>()) return false;
  return std::get<std::shared_ptr<const List>>(value_->is)->reals(index, names, into);
}

bool Field::is_absent() const {
  return !value_ || is<std::nullptr_t>();
}

double Field::number(double least, double most) const {
  const auto given = value_ ? number_of(*value_) : std::nullopt;
  if (!given) {
    refuse_kind(least == -kNoLimit ? "a number" : limits(least, most));
    return 0;
  }
  if (std::isfinite(*given) && *given >= least && *given <= most) return *given;
  refuse("expected ", limits(least, most), ", got ", *given);
  return 0;
}

double Field::float32(double least, double most) const {
  const auto given = value_ ? number_of(*value_) : std::nullopt;
  const double noise = std::numeric_limits<float>::epsilon() * std::max(std::abs(least), std::abs(most));
  const bool is_noise = given && std::isfinite(noise) && *given >= least - noise && *given <= most + noise;
  return is_noise ? std::clamp(*given, least, most) : number(least, most);
}

std::int64_t Field::read_integer(std::int64_t least, std::int64_t most) const {
  if (!value_ || !number_of(*value_)) {
    refuse_kind("a whole number");
    return least;
  }
  const auto given = integer_of(*value_);
  if (given && *given >= least && *given <= most) return *given;
  refuse("expected a whole number from ", least, " to ", most, ", got ", describe_value(*value_));
  return least;
}

std::optional<std::string_view> Field::characters() const {
  if (is<std::string>()) return std::get<std::string>(value_->is);
  if (!is<Value::Bytes>()) return std::nullopt;
  const auto& bytes = std::get<Value::Bytes>(value_->is).bytes;
  return std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

std::string_view Field::text() const {
  const auto given = characters();
  if (!given) {
    refuse_kind("a string");
    return {};
  }
  if (!is_utf8(*given)) {  // splitters have checked strings
    refuse("expected a string, got a byte string that is not UTF-8");
    return {};
  }
  if (!given->contains('\0')) return *given;
  refuse("expected a string without NUL characters, got one with them");
  return {};
}

bool Field::truth() const {
  if (is<bool>()) return std::get<bool>(value_->is);
  const auto given = value_ ? integer_of(*value_) : std::nullopt;
  if (given && (*given == 0 || *given == 1)) return *given == 1;
  if (value_ && number_of(*value_)) {
    refuse("expected true or false, got ", describe_value(*value_));
  } else {
    refuse_kind("true or false");
  }
  return false;
}

double Field::seconds(double most) const {
  if (const auto given = value_ ? number_of(*value_) : std::nullopt) {
    const std::string hint = *given > most ? unit_hint(*given, most) : "";
    if (!hint.empty()) refuse("expected ", limits(0, most), ", got ", *given, hint);
    return number(0, most);
  }
  if (!is<Value::Object>()) {
    refuse_kind(icd::sentence("a number, ", kTimes));
    return 0;
  }
  const auto has = [this](std::string_view name) {
    return std::ranges::count(std::get<Value::Object>(value_->is), name, &Value::Member::first) > 0;
  };
  const auto is_spelt = [&](const TimeNames& names) { return has(names.nanoseconds); };
  const auto count = std::ranges::count_if(kTimeNames, is_spelt);
  if (count > 1 || (has("secs") && has("sec"))) {
    refuse("expected one of ", kTimes, ", got members of two");
    return 0;
  }
  const auto& names =
      count == 1 ? *std::ranges::find_if(kTimeNames, is_spelt) : kTimeNames[has("sec") ? 1 : 0];
  constexpr std::uint32_t kLastNanosecond = 999'999'999;
  const auto secs = member(names.seconds).integer<std::uint32_t>(0, static_cast<std::uint32_t>(most));
  const auto nsecs = member(names.nanoseconds).integer<std::uint32_t>(0, kLastNanosecond);
  return std::min(secs + nsecs / 1e9, most);
}

void Field::refuse_kind(std::string_view expected) const {
  if (value_) {
    refuse("expected ", expected, ", got ", value_->kind());
  } else {
    miss();
  }
}

/// Not for a member of a missing object: that is named itself.
void Field::miss() const {
  if (parent_ == nullptr) return refuse("missing");
  if (!parent_->value_) return;
  std::string hint;
  const auto* const around = std::get_if<Value::Object>(&parent_->value_->is);
  for (const auto& [missing, found, advice] : kMisplaced) {
    if (around == nullptr || missing != name_ || !hint.empty()) continue;
    if (std::ranges::count(*around, found, &Value::Member::first) > 0)
      hint = icd::sentence(" (found ", found, ": ", advice, ")");
  }
  reading_.miss(path(), hint);
}

std::string Field::path() const {
  if (!parent_) return "the body";
  if (name_.empty()) return icd::sentence(parent_->path(), "[", index_, "]");
  if (!parent_->parent_) return std::string(name_);
  return icd::sentence(parent_->path(), ".", name_);
}

}  // namespace adit::codec
