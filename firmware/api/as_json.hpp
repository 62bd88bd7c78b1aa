#pragma once

#include <concepts>
#include <utility>

#include "api/run_view.hpp"
#include "codec/value.hpp"

namespace adit::api {

/// What the page's JSON is made of. Absent optionals are null.
inline codec::Value json(const std::string& text) {
  return {text};
}
inline codec::Value json(bool value) {
  return {value};
}
inline codec::Value json(double value) {
  return {value};
}
template <std::signed_integral Whole>
codec::Value json(Whole value) {
  return {std::int64_t{value}};
}
template <std::unsigned_integral Whole>
  requires(!std::same_as<Whole, bool>)
codec::Value json(Whole value) {
  return {std::uint64_t{value}};
}

inline codec::Value json(const icd::Point& point) {
  return {codec::Value::Object{{"x", json(point.x)}, {"y", json(point.y)}, {"z", json(point.z)}}};
}

codec::Value json(const icd::RunStatus& run);
codec::Value json(const EndpointRow& row);
codec::Value json(const RobotRow& row);
codec::Value json(const ReportRow& row);
codec::Value json(const ReportStep& step);
codec::Value json(const ActivityRow& row);
codec::Value json(const RefusalRow& row);
codec::Value json(const AsideRow& row);
codec::Value json(const LightRow& row);

template <class T>
codec::Value json(const std::optional<T>& value) {
  return value ? json(*value) : codec::Value{};
}

template <class Row>
codec::Value json(const std::vector<Row>& rows) {
  codec::Value::Array array;
  array.reserve(rows.size());
  for (const Row& row : rows) array.push_back(json(row));
  return {std::move(array)};
}

}  // namespace adit::api
