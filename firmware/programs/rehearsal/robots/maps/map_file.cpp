#include "rehearsal/robots/maps/map_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
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

namespace {

using Words = std::vector<std::string_view>;

/// Takes the next line off `rest`, without its \n or \r\n. Nothing at the end.
std::optional<std::string_view> take_line(std::string_view& rest) {
  if (rest.empty()) return std::nullopt;
  const std::size_t end = rest.find('\n');
  std::string_view line = rest.substr(0, end);
  rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

/// The words of a line, split at blanks.
Words words_of(std::string_view line) {
  constexpr std::string_view kBlanks = " \t\r";
  Words words;
  while (true) {
    line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
    if (line.empty()) return words;
    const std::string_view word = line.substr(0, line.find_first_of(kBlanks));
    words.push_back(word);
    line.remove_prefix(word.size());
  }
}

/// All of `text` as one number, and nothing else.
template <class Number>
std::optional<Number> parse_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return number;
}

/// As many finite numbers as there are words; nothing if a word is none.
std::optional<std::vector<double>> numbers_of(const Words& words) {
  std::vector<double> numbers;
  for (const std::string_view word : words) {
    const auto number = parse_number<double>(word);
    if (!number || !std::isfinite(*number)) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

constexpr const char* kPadding = "_";

/// The header of a PCD or PLY file, and its points.
struct PointFile {
  std::vector<CloudField> fields;  // one after another, in the file's order
  std::uint32_t step = 0;          // bytes of a point
  std::uint64_t points = 0;
  bool is_ascii = false;  // else binary, little endian
  std::size_t lines = 0;  // of the header
  std::optional<Placement> origin;

  void add_field(std::string_view name, int datatype, std::uint32_t count) {
    fields.push_back({std::string(name), step, datatype, count});
    step += bytes_of(datatype) * count;
  }
};

/// A type's name in PLY, old or new, or its letter and size in PCD, as the ICD's datatype; 0 for others.
int datatype_of(const std::string& type) {
  static const std::map<std::string, int> kDatatypes = {
      {"char", 1},  {"int8", 1},    {"I1", 1}, {"uchar", 2},         {"uint8", 2},          {"U1", 2},
      {"short", 3}, {"int16", 3},   {"I2", 3}, {"ushort", 4},        {"uint16", 4},         {"U2", 4},
      {"int", 5},   {"int32", 5},   {"I4", 5}, {"uint", 6},          {"uint32", 6},         {"U4", 6},
      {"float", 7}, {"float32", 7}, {"F4", 7}, {"double", kFloat64}, {"float64", kFloat64}, {"F8", kFloat64}};
  const auto found = kDatatypes.find(type);
  return found == kDatatypes.end() ? 0 : found->second;
}

/// Whether x, y and z are there, each once and single, all float32 or all float64 (what the ICD and the
/// Command Posts take), and no field twice.
std::expected<void, std::string> check_fields(const std::vector<CloudField>& fields) {
  std::set<std::string> names;
  for (const CloudField& field : fields) {
    if (field.name != kPadding && !names.insert(field.name).second) {
      return std::unexpected("field '" + field.name + "' is given twice");
    }
  }
  int datatype = 0;
  for (const char* name : {"x", "y", "z"}) {
    const auto field = std::ranges::find(fields, name, &CloudField::name);
    if (field == fields.end()) return std::unexpected("no field '" + std::string(name) + "'");
    const bool is_float = field->datatype == kFloat32 || field->datatype == kFloat64;
    if (!is_float || field->count != 1 || (datatype != 0 && field->datatype != datatype)) {
      return std::unexpected("expected x, y and z to be single, and all float32 or all float64");
    }
    datatype = field->datatype;
  }
  return {};
}

/// Writes the value of `word` as little endian. False if it is no value of that type.
template <class Value>
bool put(std::string_view word, std::uint8_t* at) {
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

/// Writes the words of one line. The error is a sentence.
std::expected<void, std::string> put_point(const PointFile& file, const Words& words, std::uint8_t* point) {
  std::size_t values = 0;
  for (const CloudField& field : file.fields) values += field.count;
  if (words.size() != values) {
    return std::unexpected("expected " + std::to_string(values) + " values, got " +
                           std::to_string(words.size()));
  }
  auto word = words.begin();
  for (const CloudField& field : file.fields) {
    std::uint8_t* at = point + field.offset;
    for (std::uint32_t i = 0; i < field.count; ++i, ++word, at += bytes_of(field.datatype)) {
      if (put(field.datatype, *word, at)) continue;
      return std::unexpected("wrong value of " + field.name + ": '" + std::string(word->substr(0, 20)) + "'");
    }
  }
  return {};
}

/// One point a line.
std::expected<std::vector<std::uint8_t>, std::string> ascii_points(const PointFile& file,
                                                                   std::string_view text) {
  std::vector<std::uint8_t> bytes;
  std::vector<std::uint8_t> point(file.step);
  std::uint64_t read = 0;
  for (std::size_t line = file.lines + 1; read < file.points; ++line) {
    const auto content = take_line(text);
    if (!content) {
      return std::unexpected("expected " + std::to_string(file.points) + " points, got " +
                             std::to_string(read));
    }
    const Words words = words_of(*content);
    if (words.empty()) continue;
    if (const auto written = put_point(file, words, point.data()); !written)
      return std::unexpected("line " + std::to_string(line) + ": " + written.error());
    bytes.insert(bytes.end(), point.begin(), point.end());
    ++read;
  }
  return bytes;
}

std::expected<std::vector<std::uint8_t>, std::string> binary_points(const PointFile& file,
                                                                    std::string_view bytes) {
  if (file.points > bytes.size() / file.step) {
    return std::unexpected("expected " + std::to_string(file.points) + " points of " +
                           std::to_string(file.step) + " bytes, got " + std::to_string(bytes.size()) +
                           " bytes");
  }
  return std::vector<std::uint8_t>(bytes.begin(),
                                   bytes.begin() + static_cast<std::ptrdiff_t>(file.points * file.step));
}

template <class Value>
bool is_finite(const std::uint8_t* at) {
  Value value = 0;
  std::memcpy(&value, at, sizeof value);
  return std::isfinite(value);
}

/// Whether the point is a place.
bool is_place(const std::vector<CloudField>& fields, const std::uint8_t* point) {
  return std::ranges::all_of(fields, [&](const CloudField& field) {
    if (field.name != "x" && field.name != "y" && field.name != "z") return true;
    const std::uint8_t* const at = point + field.offset;
    return field.datatype == kFloat32 ? is_finite<float>(at) : is_finite<double>(at);
  });
}

/// The cloud of `header`, with the points in `rest`. Leaves out padding and points that are no place: the
/// ICD's clouds are dense (6.3.2).
std::expected<Cloud, std::string> cloud_of(const std::expected<PointFile, std::string>& header,
                                           std::string_view rest) {
  if (!header) return std::unexpected(header.error());
  if (const auto checked = check_fields(header->fields); !checked) return std::unexpected(checked.error());
  const auto bytes = header->is_ascii ? ascii_points(*header, rest) : binary_points(*header, rest);
  if (!bytes) return std::unexpected(bytes.error());
  Cloud cloud;
  cloud.origin = header->origin;
  std::ranges::copy_if(header->fields, std::back_inserter(cloud.fields),
                       [](const CloudField& field) { return field.name != kPadding; });
  cloud.point_step = header->step;
  cloud.data.reserve(bytes->size());
  for (auto point = bytes->begin(); point != bytes->end(); point += header->step) {
    if (is_place(header->fields, &*point)) cloud.data.insert(cloud.data.end(), point, point + header->step);
  }
  return cloud;
}

using PcdEntries = std::map<std::string_view, Words>;

std::expected<void, std::string> read_pcd_fields(PcdEntries& entries, PointFile& file) {
  constexpr std::uint32_t kMostValues = 4096;
  constexpr std::size_t kMostFields = 256;
  const Words &names = entries["FIELDS"], &sizes = entries["SIZE"], &types = entries["TYPE"];
  Words& counts = entries["COUNT"];
  if (counts.empty()) counts.assign(names.size(), "1");
  if (names.empty() || sizes.size() != names.size() || types.size() != names.size() ||
      counts.size() != names.size()) {
    return std::unexpected("FIELDS, SIZE, TYPE and COUNT: expected as many entries in each");
  }
  if (names.size() > kMostFields) return std::unexpected("FIELDS: expected at most 256");
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string field = "field '" + std::string(names[i]) + "': ", type(types[i]), size(sizes[i]);
    const int datatype = datatype_of(type + size);
    if (datatype == 0) {
      return std::unexpected(field + "a point cloud message has no type for TYPE " + type + " of SIZE " +
                             size);
    }
    const auto count = parse_number<std::uint32_t>(counts[i]);
    if (!count || *count < 1 || *count > kMostValues) {
      return std::unexpected(field + "expected a COUNT from 1 to 4096, got '" + std::string(counts[i]) + "'");
    }
    file.add_field(names[i], datatype, *count);
  }
  return {};
}

/// VIEWPOINT: tx ty tz qw qx qy qz.
std::expected<std::optional<Placement>, std::string> viewpoint_of(const Words& words) {
  if (words.empty()) return std::nullopt;
  const auto v = numbers_of(words);
  if (!v || v->size() != 7) return std::unexpected("VIEWPOINT: expected 7 numbers");
  Placement placement{.position = {(*v)[0], (*v)[1], (*v)[2]},
                      .orientation = {(*v)[4], (*v)[5], (*v)[6], (*v)[3]}};
  if (placement.orientation == Rotation{0, 0, 0, 0}) placement.orientation = {};
  if (placement == Placement{}) return std::nullopt;
  return placement;
}

std::expected<PointFile, std::string> take_pcd_header(std::string_view& rest) {
  constexpr std::size_t kMostLines = 100;  // a PCD's header has 11
  PointFile file;
  PcdEntries entries;
  while (!entries.contains("DATA")) {
    const auto line = take_line(rest);
    if (!line || ++file.lines > kMostLines)
      return std::unexpected("not a PCD file: the header has no DATA line");
    const Words words = words_of(*line);
    if (!words.empty() && !words[0].starts_with('#')) entries[words[0]] = {words.begin() + 1, words.end()};
  }
  if (const auto read = read_pcd_fields(entries, file); !read) return std::unexpected(read.error());

  const auto number = [&](std::string_view name) {
    const Words& words = entries[name];
    return words.size() == 1 ? parse_number<std::uint32_t>(words[0]) : std::nullopt;
  };
  const auto points = number("POINTS"), width = number("WIDTH"), height = number("HEIGHT");
  if (!points && !(entries["POINTS"].empty() && width && height))
    return std::unexpected("POINTS: expected a whole number");
  file.points = points ? *points : std::uint64_t{*width} * *height;

  auto origin = viewpoint_of(entries["VIEWPOINT"]);
  if (!origin) return std::unexpected(origin.error());
  file.origin = *origin;

  const std::string form(entries["DATA"].empty() ? "" : entries["DATA"][0]);
  file.is_ascii = form == "ascii";
  if (file.is_ascii || form == "binary") return file;
  const bool is_compressed = form == "binary_compressed";
  return std::unexpected("DATA: expected ascii or binary, got '" + form +
                         (is_compressed ? "': convert it with pcl_convert_pcd_ascii_binary" : "'"));
}

/// What a PLY's header said so far.
struct PlyHeader {
  PointFile file;
  std::string format;
  std::optional<std::uint64_t> vertices;
  bool in_vertex = false;

  std::expected<void, std::string> element(const Words& words) {
    in_vertex = words.size() == 3 && words[1] == "vertex";
    if (!in_vertex && !vertices) return std::unexpected("expected the first element to be vertex");
    if (!in_vertex) return {};
    if (vertices) return std::unexpected("element vertex is given twice");
    vertices = parse_number<std::uint32_t>(words[2]);
    if (vertices) return {};
    return std::unexpected("element vertex: expected a whole number, got '" + std::string(words[2]) + "'");
  }

  std::expected<void, std::string> property(const Words& words) {
    if (!in_vertex) return {};
    const int datatype = words.size() == 3 ? datatype_of(std::string(words[1])) : 0;
    if (datatype == 0) {
      return std::unexpected("property " + std::string(words.back()) +
                             " of vertex: expected a single value of a known type");
    }
    file.add_field(words[2], datatype, 1);
    return {};
  }
};

std::expected<PointFile, std::string> take_ply_header(std::string_view& rest) {
  constexpr std::size_t kMostLines = 1000;
  if (take_line(rest) != "ply") return std::unexpected("not a PLY file: the first line is not 'ply'");
  PlyHeader header;
  header.file.lines = 1;
  for (Words words; words.empty() || words[0] != "end_header";) {
    const auto line = take_line(rest);
    if (!line || ++header.file.lines > kMostLines)
      return std::unexpected("not a PLY file: the header has no end_header");
    words = words_of(*line);
    if (words.empty()) continue;
    std::expected<void, std::string> taken;
    if (words[0] == "format" && words.size() >= 2) header.format = words[1];
    if (words[0] == "element") taken = header.element(words);
    if (words[0] == "property") taken = header.property(words);
    if (!taken) return std::unexpected(taken.error());
  }
  if (!header.vertices) return std::unexpected("no element vertex");
  header.file.points = *header.vertices;
  header.file.is_ascii = header.format == "ascii";
  if (header.file.is_ascii || header.format == "binary_little_endian") return header.file;
  return std::unexpected("format: expected ascii or binary_little_endian, got '" + header.format + "'");
}

}  // namespace

std::expected<Cloud, std::string> parse_pcd(std::string_view bytes) {
  const auto header = take_pcd_header(bytes);
  return cloud_of(header, bytes);
}

std::expected<Cloud, std::string> parse_ply(std::string_view bytes) {
  const auto header = take_ply_header(bytes);
  return cloud_of(header, bytes);
}

namespace {

std::string_view trimmed(std::string_view text) {
  const Words words = words_of(text);
  return words.empty() ? "" : std::string_view(words.front().begin(), words.back().end());
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

/// [x, y, yaw]
std::optional<std::vector<double>> read_origin(std::string_view text) {
  if (!text.starts_with('[') || !text.ends_with(']')) return std::nullopt;
  std::string list(text.substr(1, text.size() - 2));
  std::ranges::replace(list, ',', ' ');
  auto numbers = numbers_of(words_of(list));
  return numbers && numbers->size() == 3 ? numbers : std::nullopt;
}

}  // namespace

std::expected<MapYaml, std::string> parse_map_yaml(std::string_view text) {
  std::map<std::string_view, std::string_view> members;
  while (const auto line = take_line(text)) {
    const std::string_view content = without_comment(*line);
    const std::size_t colon = content.find(':');
    if (colon == std::string_view::npos) continue;  // blank, "---"
    members[trimmed(content.substr(0, colon))] = unquoted(trimmed(content.substr(colon + 1)));
  }
  std::string wrong;  // the first
  const auto complain = [&](const std::string& key, const char* expected) {
    if (!wrong.empty()) return;
    wrong = key + ": expected " + expected + ", got '" +
            std::string(members.contains(key) ? members[key] : "nothing") + "'";
  };
  const auto read = [&](const char* key, double otherwise) {
    if (!members.contains(key)) return otherwise;
    const auto numbers = numbers_of({members[key]});
    if (!numbers) complain(key, "a number");
    return numbers ? numbers->front() : otherwise;
  };
  MapYaml yaml;
  yaml.image = members["image"];
  yaml.resolution = read("resolution", 0);
  if (yaml.resolution <= 0) complain("resolution", "more than 0");
  if (const auto origin = read_origin(members["origin"])) {
    yaml.x = (*origin)[0];
    yaml.y = (*origin)[1];
    yaml.yaw = (*origin)[2];
  } else {
    complain("origin", "[x, y, yaw]");
  }
  yaml.negate = read("negate", 0) != 0;
  yaml.occupied_thresh = read("occupied_thresh", yaml.occupied_thresh);
  yaml.free_thresh = read("free_thresh", yaml.free_thresh);
  if (yaml.free_thresh > yaml.occupied_thresh) complain("free_thresh", "at most occupied_thresh");
  if (members.contains("mode") && members["mode"] != "trinary") complain("mode", "trinary");
  if (!wrong.empty()) return std::unexpected(wrong);
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
  if (const std::string_view magic = take_word(bytes); magic != "P5") {
    return std::unexpected("expected a binary PGM (P5), got '" + std::string(magic.substr(0, 20)) + "'");
  }
  std::uint32_t width = 0, height = 0, white = 0;
  for (const auto& [number, what, most] : {std::tuple{&width, "width", kLongestSide},
                                           {&height, "height", kLongestSide},
                                           {&white, "largest grey", 255}}) {
    const std::string_view word = take_word(bytes);
    *number = parse_number<std::uint32_t>(word).value_or(0);
    if (*number >= 1 && *number <= most) continue;
    return std::unexpected(std::string(what) + ": expected a number from 1 to " + std::to_string(most) +
                           ", got '" + std::string(word.substr(0, 20)) + "'");
  }
  bytes.remove_prefix(std::min<std::size_t>(1, bytes.size()));  // exactly one blank ends the header

  const std::size_t size = std::size_t{width} * height;
  if (bytes.size() < size) {
    return std::unexpected("expected " + std::to_string(width) + " x " + std::to_string(height) + " = " +
                           std::to_string(size) + " cells, got " + std::to_string(bytes.size()));
  }
  Grid grid;
  grid.resolution = yaml.resolution;
  grid.width = width;
  grid.height = height;
  grid.origin = {.position = {yaml.x, yaml.y, 0}, .orientation = rotation_of(yaml.yaw)};
  grid.cells.reserve(size);
  const auto cells = trinary(white, yaml);
  for (std::size_t row = height; row-- > 0;) {
    for (const char grey : bytes.substr(row * width, width))
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
