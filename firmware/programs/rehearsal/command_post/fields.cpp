#include "rehearsal/command_post/fields.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

namespace adit::rehearsal {
namespace {

constexpr auto kTypes = std::to_array<std::string_view>({
#include "icd/artifact_types.inc"
});

}  // namespace

std::string Field::path_of(std::string_view name) const {
  return path_.empty() ? std::string(name) : path_ + "." + std::string(name);
}

std::nullopt_t Field::breaks(std::string_view what, Measured measured) const {
  const std::string where = path_.empty() ? "the body" : path_;
  findings_->breaks(where + ": " + std::string(what), measured);
  return std::nullopt;
}

std::nullopt_t Field::expected(std::string_view what) const {
  const std::string got =
      value_->is_number() ? line_of(*value_) : std::string("a value of type ") + value_->type_name();
  return breaks("expected " + std::string(what) + ", got " + got);
}

std::optional<Field> Field::optional_member(const char* name) const {
  if (!value_->is_object()) return std::nullopt;
  const auto found = value_->find(name);
  if (found == value_->end()) return std::nullopt;
  return Field(*found, path_of(name), *findings_);
}

std::optional<Field> Field::member(const char* name, Measured measured) const {
  if (!is_object()) return std::nullopt;
  auto found = optional_member(name);
  if (!found) findings_->breaks("Missing field '" + path_of(name) + "'", measured);
  return found;
}

std::optional<std::vector<Field>> Field::elements() const {
  if (!value_->is_array()) return expected("an array");
  std::vector<Field> all;
  all.reserve(value_->size());
  for (const Json& element : *value_) {
    all.emplace_back(element, path_ + "[" + std::to_string(all.size()) + "]", *findings_);
  }
  return all;
}

bool Field::is_object() const {
  if (!value_->is_object()) expected("an object");
  return value_->is_object();
}

std::optional<double> Field::number() const {
  if (!value_->is_number()) return expected("a number");
  const auto number = value_->get<double>();
  if (!std::isfinite(number)) return breaks("expected a finite number");  // CBOR can say so, JSON cannot
  return number;
}

std::optional<std::int64_t> Field::integer(std::int64_t least, std::int64_t most) const {
  const bool fits = value_->is_number_integer() &&
                    !(value_->is_number_unsigned() && value_->get<std::uint64_t>() > INT64_MAX);
  const std::int64_t integer = fits ? value_->get<std::int64_t>() : 0;
  if (fits && integer >= least && integer <= most) return integer;
  return expected("an integer from " + std::to_string(least) + " to " + std::to_string(most));
}

std::optional<bool> Field::boolean() const {
  if (!value_->is_boolean()) return expected("a boolean");
  return value_->get<bool>();
}

std::optional<std::string> Field::text() const {
  if (!value_->is_string()) return expected("a text string");
  return value_->get<std::string>();
}

std::optional<double> Field::number(const char* name) const {
  const auto field = member(name);
  return field ? field->number() : std::nullopt;
}

std::optional<std::int64_t> Field::integer(const char* name, std::int64_t least, std::int64_t most) const {
  const auto field = member(name);
  return field ? field->integer(least, most) : std::nullopt;
}

std::optional<std::string> Field::text(const char* name) const {
  const auto field = member(name);
  return field ? field->text() : std::nullopt;
}

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return text;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view space = " \t\r\n";
  const auto first = text.find_first_not_of(space);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(space) - first + 1);
}

bool is_artifact_type(std::string_view type) {
  return std::ranges::any_of(kTypes, [lower_case = lower(std::string(type))](std::string_view known) {
    return lower(std::string(known)) == lower_case;
  });
}

bool is_word_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

std::string tame(std::string_view text) {
  constexpr std::size_t longest = 32;
  std::string tamed(text.substr(0, longest));
  std::ranges::replace_if(tamed, std::not_fn(is_word_character), '_');
  return tamed;
}

bool is_robot_name(std::string_view name) {
  return !name.empty() && name.size() <= 10 && std::ranges::all_of(name, is_word_character);
}

namespace {

std::optional<Quaternion> read_quaternion(const Field& quaternion) {
  const auto x = quaternion.number("x"), y = quaternion.number("y"), z = quaternion.number("z"),
             w = quaternion.number("w");
  if (!x || !y || !z || !w) return std::nullopt;
  constexpr double kNoise = 2e-6;  // of float32, and of printed digits
  const double length = std::hypot(std::hypot(*x, *y, *z), *w);
  if (!(std::abs(length - 1) <= kNoise)) {
    quaternion.breaks("expected a quaternion of length 1, got one of length " + std::to_string(length),
                      Measured::Takes);
  }
  return Quaternion{*x, *y, *z, *w};
}

}  // namespace

std::optional<Point> read_point(const Field& point) {
  const auto x = point.number("x"), y = point.number("y"), z = point.number("z");
  if (!x || !y || !z) return std::nullopt;
  return Point{*x, *y, *z};
}

std::optional<Pose> read_pose(const Field& pose) {
  const auto position = pose.member("position");
  const auto orientation = pose.member("orientation");
  if (!position || !orientation) return std::nullopt;
  const auto point = read_point(*position);
  const auto quaternion = read_quaternion(*orientation);
  if (!point || !quaternion) return std::nullopt;
  return Pose{*point, *quaternion};
}

void read_header(const Field& message, std::vector<Stamp>& stamps) {
  const auto header = message.optional_member("header");
  if (!header || !header->is_object()) return;
  if (const auto frame_id = header->optional_member("frame_id")) {
    const auto text = frame_id->text();
    // The measured server writes "darpa" over any other, saying nothing.
    if (text && *text != "darpa") frame_id->breaks("expected \"darpa\" (ICD 6.1)", Measured::Takes);
  }
  if (const auto stamp = header->optional_member("stamp")) {
    const auto seconds = stamp->number();
    if (!seconds) return;
    if (*seconds < 0) {
      stamp->breaks("expected seconds from 0");
    } else {
      stamps.push_back({*seconds, stamp->path()});
    }
  }
}

}  // namespace adit::rehearsal
