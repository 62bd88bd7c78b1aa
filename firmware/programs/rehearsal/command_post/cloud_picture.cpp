#include <algorithm>
#include <bit>
#include <fstream>
#include <iterator>

#include "rehearsal/command_post/pictures.hpp"

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

}  // namespace adit::rehearsal
