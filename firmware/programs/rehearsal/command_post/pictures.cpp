#include "rehearsal/command_post/pictures.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <functional>

namespace adit::rehearsal {
namespace {

char type_letter(std::uint32_t datatype) {
  if (datatype >= 7) return 'F';
  return datatype % 2 == 1 ? 'I' : 'U';
}

/// A point without its gaps.
std::size_t packed_size(const Cloud& cloud) {
  std::size_t size = 0;
  for (const CloudField& field : cloud.fields)
    size += std::size_t{field.count} * size_of_datatype(field.datatype);
  return size;
}

template <class Word>
void write_words(std::ofstream& file, const char* title, const std::vector<CloudField>& fields, Word word) {
  file << title;
  for (const CloudField& field : fields) file << ' ' << word(field);
  file << '\n';
}

void write_header(std::ofstream& file, const Cloud& cloud, std::size_t points) {
  file << "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n";
  write_words(file, "FIELDS", cloud.fields, [](const CloudField& field) {
    const std::string name = tame(field.name);
    return name.empty() ? "_" : name;
  });
  write_words(file, "SIZE", cloud.fields, [](const auto& field) { return size_of_datatype(field.datatype); });
  write_words(file, "TYPE", cloud.fields, [](const auto& field) { return type_letter(field.datatype); });
  write_words(file, "COUNT", cloud.fields, [](const auto& field) { return field.count; });
  const Pose origin = cloud.origin.value_or(Pose{});
  const Point& at = origin.position;
  const Quaternion& turn = origin.orientation;
  file.precision(17);
  file << "WIDTH " << points << "\nHEIGHT 1\nVIEWPOINT " << at.x << ' ' << at.y << ' ' << at.z << ' '
       << turn.w << ' ' << turn.x << ' ' << turn.y << ' ' << turn.z << "\nPOINTS " << points
       << "\nDATA binary\n";
}

/// Appends one field of a point to `out`, in little-endian order.
void append_field(std::string& out, const char* point, const CloudField& field, bool bigendian) {
  const std::size_t size = size_of_datatype(field.datatype);
  const char* value = point + field.offset;
  if (!bigendian) {
    out.append(value, size * field.count);
    return;
  }
  for (std::uint32_t i = 0; i < field.count; ++i, value += size) {
    std::reverse_copy(value, value + size, std::back_inserter(out));
  }
}

}  // namespace

bool write_cloud_picture(const Cloud& cloud, const std::string& data, const std::string& stem) {
  constexpr std::size_t flush_at = std::size_t{256} << 10;
  const std::size_t points = data.size() / cloud.point_step;
  std::ofstream file(stem + ".pcd", std::ios::binary);
  write_header(file, cloud, points);
  std::string out;
  for (std::size_t i = 0; i < points && file; ++i) {
    for (const CloudField& field : cloud.fields) {
      append_field(out, data.data() + i * cloud.point_step, field, cloud.is_bigendian);
      if (out.size() < flush_at) continue;
      file.write(out.data(), static_cast<std::streamsize>(out.size()));
      out.clear();
    }
  }
  file.write(out.data(), static_cast<std::streamsize>(out.size()));
  file.close();
  return !file.fail();
}

std::size_t picture_size(const MapMessage& map) {
  constexpr std::size_t headers = 1024;
  const auto* const cloud = std::get_if<Cloud>(&map.msg);
  if (cloud == nullptr) return map.data.size() + headers;
  const std::size_t header = headers + cloud->fields.size() * 64;
  return header + map.data.size() / cloud->point_step * packed_size(*cloud);
}

namespace {

constexpr unsigned char kUnknownCell = 255;

char grey_of(char cell) {
  const auto value = static_cast<unsigned char>(cell);
  if (value == kUnknownCell) return static_cast<char>(205);
  if (value > 100) return static_cast<char>(255);  // no value of the ICD's
  return static_cast<char>(254 - (254 * value + 50) / 100);
}

double yaw_of(const Quaternion& q) {
  return std::atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z));
}

bool write_pgm(const Grid& grid, const std::string& cells, const std::string& path) {
  std::ofstream file(path, std::ios::binary);
  file << "P5\n" << grid.width << ' ' << grid.height << "\n255\n";
  std::string row(grid.width, '\0');
  for (std::size_t y = grid.height; y-- > 0;) {
    const auto first = cells.begin() + static_cast<std::ptrdiff_t>(y * grid.width);
    std::transform(first, first + grid.width, row.begin(), grey_of);
    file.write(row.data(), static_cast<std::streamsize>(row.size()));
  }
  file.close();
  return !file.fail();
}

}  // namespace

bool write_grid_picture(const Grid& grid, const std::string& cells, const std::string& stem) {
  if (!write_pgm(grid, cells, stem + ".pgm")) return false;
  std::ofstream file(stem + ".yaml");
  const Point& at = grid.origin.position;
  file << "image: " << stem.substr(stem.rfind('/') + 1) << ".pgm\n"
       << "resolution: " << text_of(grid.resolution) << "\n"
       << "origin: [" << text_of(at.x) << ", " << text_of(at.y) << ", "
       << text_of(yaw_of(grid.origin.orientation)) << "]\n"
       << "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
  file.close();
  return !file.fail();
}

std::string tame(std::string_view text) {
  constexpr std::size_t longest = 32;
  std::string tamed(text.substr(0, longest));
  std::ranges::replace_if(tamed, std::not_fn(is_word_character), '_');
  return tamed;
}

}  // namespace adit::rehearsal
