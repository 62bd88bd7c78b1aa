#include "rehearsal/robots/maps/map_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace adit::robots {

std::expected<std::string, std::string> read_file(const std::filesystem::path& file) {
  constexpr std::uintmax_t kLargest = 256u << 20;
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) return std::unexpected(error.message());
  if (size > kLargest) return std::unexpected("larger than 268 MB");
  std::ifstream stream(file, std::ios::binary);
  std::string text(size, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(size));
  if (!stream) return std::unexpected("cannot be read");
  return text;
}

std::optional<std::string_view> take_line(std::string_view& rest) {
  if (rest.empty()) return std::nullopt;
  const std::size_t end = rest.find('\n');
  std::string_view line = rest.substr(0, end);
  rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

std::vector<std::string_view> words_of(std::string_view line) {
  constexpr std::string_view kBlanks = " \t\r";
  std::vector<std::string_view> words;
  while (true) {
    line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
    if (line.empty()) return words;
    const std::string_view word = line.substr(0, line.find_first_of(kBlanks));
    words.push_back(word);
    line.remove_prefix(word.size());
  }
}

namespace {

constexpr const char* kPadding = "_";

bool is_coordinate(const CloudField& field) {
  return field.name == "x" || field.name == "y" || field.name == "z";
}

/// Writes the value of `word` as little endian. False if it is no value of that type.
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

namespace {

struct PcdHeader {
  std::map<std::string_view, std::vector<std::string_view>> entries;
  std::size_t lines = 0;

  std::vector<std::string_view> find(std::string_view name) const {
    const auto found = entries.find(name);
    return found == entries.end() ? std::vector<std::string_view>{} : found->second;
  }
};

std::expected<PcdHeader, std::string> take_pcd_header(std::string_view& rest) {
  constexpr std::size_t kMostLines = 100;  // a PCD's header has 11
  PcdHeader header;
  while (const auto line = take_line(rest)) {
    if (++header.lines > kMostLines) break;
    auto words = words_of(*line);
    if (words.empty() || words[0].starts_with('#')) continue;
    const std::string_view name = words[0];
    words.erase(words.begin());
    header.entries[name] = std::move(words);
    if (name == "DATA") return header;
  }
  return std::unexpected("not a PCD file: the header has no DATA line");
}

/// PCD's type letter and size as the ICD's datatype, or 0.
int datatype_of(std::string_view type, std::string_view size) {
  static const std::map<std::string, int> kDatatypes = {
      {"I1", 1}, {"U1", 2}, {"I2", 3}, {"U2", 4}, {"I4", 5}, {"U4", 6}, {"F4", kFloat32}, {"F8", kFloat64}};
  const auto found = kDatatypes.find(std::string(type) + std::string(size));
  return found == kDatatypes.end() ? 0 : found->second;
}

std::expected<PointTable, std::string> table_of(const PcdHeader& header) {
  constexpr std::uint32_t kMostValues = 4096;
  constexpr std::size_t kMostFields = 256;
  const auto fields = header.find("FIELDS"), sizes = header.find("SIZE"), types = header.find("TYPE");
  auto counts = header.find("COUNT");
  if (counts.empty()) counts.assign(fields.size(), "1");
  if (fields.empty() || sizes.size() != fields.size() || types.size() != fields.size() ||
      counts.size() != fields.size()) {
    return std::unexpected("FIELDS, SIZE, TYPE and COUNT: expected as many entries in each");
  }
  if (fields.size() > kMostFields) return std::unexpected("FIELDS: expected at most 256");
  PointTable table;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::string name(fields[i]);
    const int datatype = datatype_of(types[i], sizes[i]);
    if (datatype == 0) {
      return std::unexpected("field '" + name + "': a point cloud message has no type for TYPE " +
                             std::string(types[i]) + " of SIZE " + std::string(sizes[i]));
    }
    const auto count = parse_number<std::uint32_t>(counts[i]);
    if (!count || *count < 1 || *count > kMostValues) {
      return std::unexpected("field '" + name + "': expected a COUNT from 1 to 4096, got '" +
                             std::string(counts[i]) + "'");
    }
    table.add_field(name, datatype, *count);
  }
  if (auto checked = table.check(); !checked) return std::unexpected(checked.error());
  return table;
}

std::expected<std::uint64_t, std::string> points_of(const PcdHeader& header) {
  const auto number = [&](std::string_view name) -> std::optional<std::uint32_t> {
    const auto words = header.find(name);
    return words.size() == 1 ? parse_number<std::uint32_t>(words[0]) : std::nullopt;
  };
  if (const auto points = number("POINTS")) return *points;
  const auto width = number("WIDTH"), height = number("HEIGHT");
  if (header.find("POINTS").empty() && width && height) return std::uint64_t{*width} * *height;
  return std::unexpected("POINTS: expected a whole number");
}

/// VIEWPOINT: tx ty tz qw qx qy qz.
std::expected<std::optional<Placement>, std::string> viewpoint_of(const PcdHeader& header) {
  const auto words = header.find("VIEWPOINT");
  if (words.empty()) return std::nullopt;
  std::vector<double> v;
  for (const std::string_view word : words) {
    if (const auto value = parse_number<double>(word); value && std::isfinite(*value)) v.push_back(*value);
  }
  if (v.size() != 7 || words.size() != 7) return std::unexpected("VIEWPOINT: expected 7 numbers");
  Placement placement{.position = {v[0], v[1], v[2]}, .orientation = {v[4], v[5], v[6], v[3]}};
  if (placement.orientation == Rotation{0, 0, 0, 0}) placement.orientation = {};
  if (placement == Placement{}) return std::nullopt;
  return placement;
}

}  // namespace

std::expected<Cloud, std::string> parse_pcd(std::string_view bytes) {
  std::string_view rest = bytes;
  const auto header = take_pcd_header(rest);
  if (!header) return std::unexpected(header.error());
  const auto table = table_of(*header);
  if (!table) return std::unexpected(table.error());
  const auto points = points_of(*header);
  if (!points) return std::unexpected(points.error());
  const auto origin = viewpoint_of(*header);
  if (!origin) return std::unexpected(origin.error());

  const auto data = header->find("DATA");
  const std::string_view form = data.empty() ? "" : data[0];
  if (form != "ascii" && form != "binary") {
    return std::unexpected(
        "DATA: expected ascii or binary, got '" + std::string(form) +
        (form == "binary_compressed" ? "': convert it with pcl_convert_pcd_ascii_binary" : "'"));
  }
  auto cloud = form == "ascii" ? table->from_ascii(rest, *points, header->lines + 1)
                               : table->from_binary(rest, *points);
  if (cloud) cloud->origin = *origin;
  return cloud;
}

namespace {

/// PLY's type names, old and new, as the ICD's datatypes; 0 for others.
int datatype_of(std::string_view type) {
  static const std::map<std::string_view, int> kDatatypes = {
      {"char", 1},         {"int8", 1},           {"uchar", 2},         {"uint8", 2},
      {"short", 3},        {"int16", 3},          {"ushort", 4},        {"uint16", 4},
      {"int", 5},          {"int32", 5},          {"uint", 6},          {"uint32", 6},
      {"float", kFloat32}, {"float32", kFloat32}, {"double", kFloat64}, {"float64", kFloat64}};
  const auto found = kDatatypes.find(type);
  return found == kDatatypes.end() ? 0 : found->second;
}

using Words = std::vector<std::string_view>;

struct PlyHeader {
  std::string format;
  std::optional<std::uint64_t> vertices;
  PointTable table;
  std::size_t lines = 1;  // "ply"
  bool in_vertex = false;

  std::expected<void, std::string> element(const Words& words) {
    in_vertex = words.size() == 3 && words[1] == "vertex";
    if (!in_vertex) {
      if (vertices) return {};
      return std::unexpected("expected the first element to be vertex");
    }
    if (vertices) return std::unexpected("element vertex is given twice");
    vertices = parse_number<std::uint32_t>(words[2]);
    if (!vertices)
      return std::unexpected("element vertex: expected a whole number, got '" + std::string(words[2]) + "'");
    return {};
  }

  std::expected<void, std::string> property(const Words& words) {
    if (!in_vertex) return {};
    const int datatype = words.size() == 3 ? datatype_of(words[1]) : 0;
    if (datatype == 0) {
      return std::unexpected("property " + std::string(words.back()) +
                             " of vertex: expected a single value of a known type");
    }
    table.add_field(std::string(words[2]), datatype, 1);
    return {};
  }
};

std::expected<PlyHeader, std::string> take_ply_header(std::string_view& rest) {
  constexpr std::size_t kMostLines = 1000;
  if (take_line(rest).value_or("") != "ply")
    return std::unexpected("not a PLY file: the first line is not 'ply'");
  PlyHeader header;
  while (const auto line = take_line(rest)) {
    if (++header.lines > kMostLines) break;
    const Words words = words_of(*line);
    if (words.empty()) continue;
    std::expected<void, std::string> taken;
    if (words[0] == "end_header") return header;
    if (words[0] == "format" && words.size() >= 2) header.format = words[1];
    if (words[0] == "element") taken = header.element(words);
    if (words[0] == "property") taken = header.property(words);
    if (!taken) return std::unexpected(taken.error());
  }
  return std::unexpected("not a PLY file: the header has no end_header");
}

}  // namespace

std::expected<Cloud, std::string> parse_ply(std::string_view bytes) {
  std::string_view rest = bytes;
  const auto header = take_ply_header(rest);
  if (!header) return std::unexpected(header.error());
  const auto vertices = header->vertices;
  if (!vertices) return std::unexpected("no element vertex");
  if (const auto checked = header->table.check(); !checked) return std::unexpected(checked.error());
  if (header->format == "ascii") return header->table.from_ascii(rest, *vertices, header->lines + 1);
  if (header->format == "binary_little_endian") return header->table.from_binary(rest, *vertices);
  return std::unexpected("format: expected ascii or binary_little_endian, got '" + header->format + "'");
}

namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::string_view without_comment(std::string_view line) {
  if (line.starts_with('#')) return {};
  return line.substr(0, line.find(" #"));
}

std::string_view unquoted(std::string_view text) {
  const bool quoted =
      text.size() >= 2 && (text.front() == '"' || text.front() == '\'') && text.back() == text.front();
  return quoted ? text.substr(1, text.size() - 2) : text;
}

std::optional<double> finite_number(std::string_view text) {
  const auto number = parse_number<double>(trimmed(text));
  return number && std::isfinite(*number) ? number : std::nullopt;
}

/// Members by key, read one by one; the first that is wrong is kept.
class Members {
 public:
  explicit Members(std::string_view text) {
    while (const auto line = take_line(text)) {
      const std::string_view content = without_comment(*line);
      const std::size_t colon = content.find(':');
      if (colon == std::string_view::npos) continue;  // blank, "---"
      values_[trimmed(content.substr(0, colon))] = unquoted(trimmed(content.substr(colon + 1)));
    }
  }

  std::optional<std::string_view> find(std::string_view key) const {
    const auto found = values_.find(key);
    if (found == values_.end()) return std::nullopt;
    return found->second;
  }

  double number(std::string_view key, std::optional<double> otherwise) {
    const auto value = find(key);
    if (!value && otherwise) return *otherwise;
    const auto number = finite_number(value.value_or(""));
    if (!number) complain(key, "expected a number");
    return number.value_or(0);
  }

  /// [x, y, yaw]
  void origin(MapYaml& yaml) {
    std::string_view list = find("origin").value_or("");
    if (!list.starts_with('[') || !list.ends_with(']')) return complain("origin", "expected [x, y, yaw]");
    list = list.substr(1, list.size() - 2);
    for (double* const value : {&yaml.x, &yaml.y, &yaml.yaw}) {
      const std::size_t comma = list.find(',');
      const auto number = finite_number(list.substr(0, comma));
      if (!number || (value == &yaml.yaw) != (comma == std::string_view::npos)) {
        return complain("origin", "expected [x, y, yaw]");
      }
      *value = *number;
      list.remove_prefix(comma == std::string_view::npos ? list.size() : comma + 1);
    }
  }

  void complain(std::string_view key, std::string_view what) {
    if (wrong_.empty()) {
      wrong_ = std::string(key) + ": " + std::string(what) + ", got '" +
               std::string(find(key).value_or("nothing")) + "'";
    }
  }
  const std::string& wrong() const { return wrong_; }

 private:
  std::map<std::string_view, std::string_view> values_;
  std::string wrong_;
};

}  // namespace

std::expected<MapYaml, std::string> parse_map_yaml(std::string_view text) {
  Members members(text);
  MapYaml yaml;
  yaml.image = members.find("image").value_or("");
  yaml.resolution = members.number("resolution", std::nullopt);
  if (yaml.resolution <= 0) members.complain("resolution", "expected more than 0");
  members.origin(yaml);
  yaml.negate = members.number("negate", 0) != 0;
  yaml.occupied_thresh = members.number("occupied_thresh", yaml.occupied_thresh);
  yaml.free_thresh = members.number("free_thresh", yaml.free_thresh);
  if (yaml.free_thresh > yaml.occupied_thresh)
    members.complain("free_thresh", "expected at most occupied_thresh");
  if (members.find("mode").value_or("trinary") != "trinary") members.complain("mode", "expected trinary");
  if (!members.wrong().empty()) return std::unexpected(members.wrong());
  return yaml;
}

namespace {

/// A PGM header's next word: blanks, line ends and comments go before it.
std::string_view take_word(std::string_view& rest) {
  constexpr std::string_view kBlanks = " \t\r\n";
  while (true) {
    rest.remove_prefix(std::min(rest.find_first_not_of(kBlanks), rest.size()));
    if (!rest.starts_with('#')) break;
    rest.remove_prefix(std::min(rest.find('\n'), rest.size()));
  }
  const std::string_view word = rest.substr(0, rest.find_first_of(kBlanks));
  rest.remove_prefix(word.size());
  return word;
}

std::expected<std::uint32_t, std::string> take_number(std::string_view& rest, const char* what,
                                                      std::uint32_t most) {
  const std::string_view word = take_word(rest);
  const auto number = parse_number<std::uint32_t>(word);
  if (number && *number >= 1 && *number <= most) return *number;
  return std::unexpected(std::string(what) + ": expected a number from 1 to " + std::to_string(most) +
                         ", got '" + std::string(word.substr(0, 20)) + "'");
}

/// map_server's trinary mode, for each grey.
std::array<std::uint8_t, 256> trinary(std::uint32_t white, const MapYaml& yaml) {
  std::array<std::uint8_t, 256> cells{};
  for (std::uint32_t grey = 0; grey < cells.size(); ++grey) {
    const double light = static_cast<double>(std::min(grey, white)) / white;
    const double occupancy = yaml.negate ? light : 1 - light;
    cells[grey] = occupancy > yaml.occupied_thresh ? 100 : occupancy < yaml.free_thresh ? 0 : kUnknown;
  }
  return cells;
}

}  // namespace

std::expected<Grid, std::string> parse_pgm(std::string_view bytes, const MapYaml& yaml) {
  constexpr std::uint32_t kLongestSide = 100'000;
  std::string_view rest = bytes;
  if (const std::string_view magic = take_word(rest); magic != "P5") {
    return std::unexpected("expected a binary PGM (P5), got '" + std::string(magic.substr(0, 20)) + "'");
  }
  const auto width = take_number(rest, "width", kLongestSide);
  if (!width) return std::unexpected(width.error());
  const auto height = take_number(rest, "height", kLongestSide);
  if (!height) return std::unexpected(height.error());
  const auto white = take_number(rest, "largest grey", 255);
  if (!white) return std::unexpected(white.error());
  rest.remove_prefix(std::min<std::size_t>(1, rest.size()));  // exactly one blank ends the header

  const std::size_t size = std::size_t{*width} * *height;
  if (rest.size() < size) {
    return std::unexpected("expected " + std::to_string(*width) + " x " + std::to_string(*height) + " = " +
                           std::to_string(size) + " cells, got " + std::to_string(rest.size()));
  }
  Grid grid;
  grid.resolution = yaml.resolution;
  grid.width = *width;
  grid.height = *height;
  grid.origin = {.position = {yaml.x, yaml.y, 0}, .orientation = rotation_of(yaml.yaw)};
  grid.cells.reserve(size);
  const auto cells = trinary(*white, yaml);
  for (std::size_t row = *height; row-- > 0;) {
    for (const char grey : rest.substr(row * *width, *width))
      grid.cells.push_back(cells[static_cast<std::uint8_t>(grey)]);
  }
  return grid;
}

namespace {

namespace fs = std::filesystem;

std::expected<MapYaml, std::string> load_yaml(const fs::path& file) {
  const auto text = read_file(file);
  auto yaml = text ? parse_map_yaml(*text) : std::unexpected(text.error());
  if (!yaml) return std::unexpected(file.filename().string() + ": " + yaml.error());
  return yaml;
}

/// The YAML of the PGM's own name; else one in its folder whose `image` is the PGM; else the defaults.
std::expected<MapYaml, std::string> yaml_beside(const fs::path& pgm) {
  for (const char* ending : {".yaml", ".yml"}) {
    const fs::path file = fs::path(pgm).replace_extension(ending);
    std::error_code error;
    if (fs::exists(file, error)) return load_yaml(file);
  }
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(pgm.parent_path(), error)) {
    if (entry.path().extension() != ".yaml") continue;
    const auto yaml = load_yaml(entry.path());
    if (yaml && fs::path(yaml->image).filename() == pgm.filename()) return yaml;
  }
  return MapYaml{};
}

bool is_map(const fs::path& file) {
  const fs::path ending = file.extension();
  return ending == ".pgm" || ending == ".pcd" || ending == ".ply";
}

std::expected<LoadedMap, std::string> parse(const fs::path& file, std::string_view bytes) {
  if (file.extension() == ".pcd") return parse_pcd(bytes);
  if (file.extension() == ".ply") return parse_ply(bytes);
  const auto yaml = yaml_beside(file);
  if (!yaml) return std::unexpected(yaml.error());
  return parse_pgm(bytes, *yaml);
}

}  // namespace

std::expected<LoadedMap, std::string> load_map(const fs::path& file) {
  if (!is_map(file)) return std::unexpected(file.string() + ": expected a .pgm, .pcd or .ply file");
  const auto bytes = read_file(file);
  if (!bytes) return std::unexpected(file.string() + ": " + bytes.error());
  auto map = parse(file, *bytes);
  if (!map) return std::unexpected(file.string() + ": " + map.error());
  if (const Cloud* cloud = std::get_if<Cloud>(&*map); cloud != nullptr && cloud->data.empty()) {
    return std::unexpected(file.string() + ": the file has no points");
  }
  return map;
}

std::expected<std::vector<fs::path>, std::string> find_maps(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  fs::recursive_directory_iterator walk(folder, error);
  for (; !error && walk != fs::recursive_directory_iterator(); walk.increment(error)) {
    std::error_code unreadable;
    if (walk->is_regular_file(unreadable) && is_map(walk->path())) files.push_back(walk->path());
  }
  if (error) return std::unexpected(folder.string() + ": " + error.message());
  std::ranges::sort(files);
  return files;
}

}  // namespace adit::robots
