#pragma once

#include <cstdint>
#include <expected>
#include <string>
#include <string_view>
#include <vector>

#include "rehearsal/robots/messages.hpp"

namespace adit::robots {

/// A file's points: fields one after another, in the file's order. What PCD and PLY have in common.
class PointTable {
 public:
  /// Adds `count` values of the ICD's `datatype`. A name of "_" is padding.
  void add_field(std::string name, int datatype, std::uint32_t count);

  /// Whether x, y and z are there, each once and single, all float32 or all float64 (what the ICD and the
  /// Command Posts take), and no field twice.
  std::expected<void, std::string> check() const;

  std::uint32_t point_step() const { return step_; }

  /// `points` points from the start of `bytes`, little endian.
  std::expected<Cloud, std::string> from_binary(std::string_view bytes, std::uint64_t points) const;
  /// One point a line; `first_line` numbers the lines of errors.
  std::expected<Cloud, std::string> from_ascii(std::string_view text, std::uint64_t points,
                                               std::size_t first_line) const;

 private:
  Cloud cloud_of(const std::vector<std::uint8_t>& bytes) const;
  bool is_finite(const std::uint8_t* point) const;

  std::vector<CloudField> fields_;
  std::uint32_t step_ = 0;
};

}  // namespace adit::robots
