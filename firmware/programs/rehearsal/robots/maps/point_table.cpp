#include "rehearsal/robots/maps/point_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <set>
#include <utility>

#include "rehearsal/robots/maps/bytes.hpp"

namespace adit::robots {
namespace {

constexpr const char* kPadding = "_";

bool is_coordinate(const CloudField& field) {
  return field.name == "x" || field.name == "y" || field.name == "z";
}

/// Writes the value that `word` holds, as little endian. False where it holds none of that type.
template <class Value>
bool put(std::string_view word, std::uint8_t* at) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto value = parse_number<Value>(word);
  if (value) std::memcpy(at, &*value, sizeof(Value));
  return value.has_value();
}

bool put(int datatype, std::string_view word, std::uint8_t* at) {
  using Put = bool (*)(std::string_view, std::uint8_t*);
  constexpr std::array<Put, 9> kPut = {
      nullptr,           put<std::int8_t>,   put<std::uint8_t>, put<std::int16_t>, put<std::uint16_t>,
      put<std::int32_t>, put<std::uint32_t>, put<float>,        put<double>};
  return kPut.at(static_cast<std::size_t>(datatype))(word, at);
}

std::string in_line(std::size_t line, const std::string& what) {
  return std::string("line ").append(std::to_string(line)).append(": ").append(what);
}

}  // namespace

void PointTable::add_field(std::string name, int datatype, std::uint32_t count) {
  fields_.push_back({std::move(name), step_, datatype, count});
  step_ += bytes_of(datatype) * count;
}

std::expected<void, std::string> PointTable::check() const {
  std::set<std::string> names;
  for (const CloudField& field : fields_) {
    if (field.name != kPadding && !names.insert(field.name).second) {
      return std::unexpected("field '" + field.name + "' is given twice");
    }
  }
  int datatype = 0;
  for (const char* name : {"x", "y", "z"}) {
    const auto field = std::ranges::find(fields_, name, &CloudField::name);
    if (field == fields_.end()) return std::unexpected("no field '" + std::string(name) + "'");
    const bool is_float = field->datatype == kFloat32 || field->datatype == kFloat64;
    if (!is_float || field->count != 1 || (datatype != 0 && field->datatype != datatype)) {
      return std::unexpected("expected x, y and z to be single, and all float32 or all float64");
    }
    datatype = field->datatype;
  }
  return {};
}

bool PointTable::is_finite(const std::uint8_t* point) const {
  return std::ranges::all_of(fields_, [&](const CloudField& field) {
    if (!is_coordinate(field)) return true;
    float single = 0;
    double value = 0;
    if (field.datatype == kFloat32) {
      std::memcpy(&single, point + field.offset, sizeof single);
      value = static_cast<double>(single);
    } else {
      std::memcpy(&value, point + field.offset, sizeof value);
    }
    return std::isfinite(value);
  });
}

/// Without the points that are no place: the ICD's clouds are dense (6.3.2).
Cloud PointTable::cloud_of(const std::vector<std::uint8_t>& bytes) const {
  Cloud cloud;
  std::ranges::copy_if(fields_, std::back_inserter(cloud.fields),
                       [](const CloudField& field) { return field.name != kPadding; });
  cloud.point_step = step_;
  cloud.data.reserve(bytes.size());
  for (std::size_t at = 0; at < bytes.size(); at += step_) {
    if (!is_finite(bytes.data() + at)) continue;
    const auto point = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    cloud.data.insert(cloud.data.end(), point, point + step_);
  }
  return cloud;
}

std::expected<Cloud, std::string> PointTable::from_binary(std::string_view bytes,
                                                          std::uint64_t points) const {
  if (points > bytes.size() / step_) {
    return std::unexpected("expected " + std::to_string(points) + " points of " + std::to_string(step_) +
                           " bytes, got " + std::to_string(bytes.size()) + " bytes");
  }
  return cloud_of({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(points * step_)});
}

std::expected<Cloud, std::string> PointTable::from_ascii(std::string_view text, std::uint64_t points,
                                                         std::size_t first_line) const {
  std::size_t values = 0;
  for (const CloudField& field : fields_) values += field.count;
  std::vector<std::uint8_t> bytes;
  std::vector<std::uint8_t> point(step_);
  std::size_t line = first_line;
  for (std::uint64_t read = 0; read < points; ++line) {
    const auto content = take_line(text);
    if (!content) {
      return std::unexpected("expected " + std::to_string(points) + " points, got " + std::to_string(read));
    }
    const auto words = words_of(*content);
    if (words.empty()) continue;
    if (words.size() != values) {
      return std::unexpected(in_line(
          line, "expected " + std::to_string(values) + " values, got " + std::to_string(words.size())));
    }
    auto word = words.begin();
    for (const CloudField& field : fields_) {
      for (std::uint32_t i = 0; i < field.count; ++i, ++word) {
        if (put(field.datatype, *word,
                point.data() + field.offset + std::size_t{i} * bytes_of(field.datatype)))
          continue;
        return std::unexpected(
            in_line(line, "wrong value of " + field.name + ": '" + std::string(word->substr(0, 20)) + "'"));
      }
    }
    bytes.insert(bytes.end(), point.begin(), point.end());
    ++read;
  }
  return cloud_of(bytes);
}

}  // namespace adit::robots
