#include "codec/byte_order.hpp"

#include <algorithm>
#include <numeric>
#include <span>

#include "icd/require.hpp"

namespace adit::codec {
namespace {

/// The value that a byte of a point belongs to.
struct Place {
  std::uint32_t begin = 0;
  std::uint32_t size = 0;  // in bytes; 0: padding
  friend bool operator==(const Place&, const Place&) = default;
};

/// False: the value overlaps another. Two names for one place are allowed.
bool take_place(std::span<Place> bytes, const Place& value) {
  const auto own = bytes.subspan(value.begin, value.size);
  if (std::ranges::all_of(own, [&](const Place& taken) { return taken == value; })) return true;
  if (std::ranges::any_of(own, [](const Place& taken) { return taken.size > 0; })) return false;
  std::ranges::fill(own, value);
  return true;
}

}  // namespace

std::optional<std::vector<std::uint32_t>> little_endian_order(const icd::PointCloud2& cloud) {
  std::vector<Place> bytes(cloud.point_step);
  std::vector<std::uint32_t> order(cloud.point_step);
  std::iota(order.begin(), order.end(), 0U);
  for (const icd::FieldSchema& field : cloud.fields) {
    const auto size = static_cast<std::uint32_t>(size_of(field.datatype));
    for (std::uint32_t i = 0; i < field.count; ++i) {
      const Place value{.begin = field.offset + i * size, .size = size};
      icd::require(value.begin <= cloud.point_step && size <= cloud.point_step - value.begin);
      if (!take_place(bytes, value)) return std::nullopt;
      for (std::uint32_t byte = 0; byte < size; ++byte) {
        order[value.begin + byte] = value.begin + size - 1 - byte;
      }
    }
  }
  return order;
}

icd::ChunkedBytes in_order(icd::ChunkedBytes points, const std::vector<std::uint32_t>& order) {
  icd::require(!order.empty());
  icd::ChunkedBytes turned;
  std::vector<std::uint8_t> came, goes;  // whole points of one piece
  while (!points.empty()) {
    const auto piece = points.pop_front();
    came.insert(came.end(), piece->begin(), piece->end());
    const std::size_t whole = came.size() - came.size() % order.size();
    goes.resize(whole);
    for (std::size_t point = 0; point < whole; point += order.size()) {
      for (std::size_t byte = 0; byte < order.size(); ++byte) {
        goes[point + byte] = came[point + order[byte]];
      }
    }
    turned.append(goes);
    came.erase(came.begin(), came.begin() + static_cast<std::ptrdiff_t>(whole));
  }
  turned.append(came);
  return turned;
}

}  // namespace adit::codec
