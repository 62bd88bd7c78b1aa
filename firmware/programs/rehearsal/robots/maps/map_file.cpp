#include "rehearsal/robots/maps/map_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>
#include <set>

#include "icd/sentence.hpp"
#include "icd/text.hpp"
#include "icd/try.hpp"
#include "rehearsal/common.hpp"

namespace adit::robots {

namespace {

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

using Words = std::vector<std::string_view>;
using Done = std::expected<void, std::string>;

constexpr std::string_view kBlanks = " \t\r\n";

/// Takes the next line off `rest`. Nothing at the end.
std::optional<std::string_view> take_line(std::string_view& rest) {
  if (rest.empty()) return std::nullopt;
  return icd::cut(rest, '\n');
}

/// Takes the next word off `rest`; "" if there is none.
std::string_view take_word(std::string_view& rest) {
  rest.remove_prefix(std::min(rest.find_first_not_of(kBlanks), rest.size()));
  const std::string_view word = rest.substr(0, rest.find_first_of(kBlanks));
  rest.remove_prefix(word.size());
  return word;
}

Words words_of(std::string_view line) {
  Words words;
  for (std::string_view word = take_word(line); !word.empty(); word = take_word(line)) words.push_back(word);
  return words;
}

/// All of `text` as one number, and nothing else.
template <class Number>
std::optional<Number> parse_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  return icd::number_in<Number>(text);
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
    step += size_of_datatype(datatype) * count;
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
Done check_fields(const std::vector<CloudField>& fields) {
  std::set<std::string> names;
  for (const CloudField& field : fields) {
    if (field.name != kPadding && !names.insert(field.name).second)
      return wrong("field '", field.name, "' is given twice");
  }
  int datatype = 0;
  for (const char* name : {"x", "y", "z"}) {
    const auto field = std::ranges::find(fields, name, &CloudField::name);
    if (field == fields.end()) return wrong("no field '", name, "'");
    const bool is_float = field->datatype == kFloat32 || field->datatype == kFloat64;
    if (!is_float || field->count != 1 || (datatype != 0 && field->datatype != datatype))
      return wrong("expected x, y and z to be single, and all float32 or all float64");
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
Done put_point(const PointFile& file, const Words& words, std::uint8_t* point) {
  std::size_t values = 0;
  for (const CloudField& field : file.fields) values += field.count;
  if (words.size() != values) return wrong("expected ", values, " values, got ", words.size());
  auto word = words.begin();
  for (const CloudField& field : file.fields) {
    std::uint8_t* at = point + field.offset;
    for (std::uint32_t i = 0; i < field.count; ++i, ++word, at += size_of_datatype(field.datatype)) {
      if (put(field.datatype, *word, at)) continue;
      return wrong("wrong value of ", field.name, ": '", word->substr(0, 20), "'");
    }
  }
  return {};
}

using Bytes = std::vector<std::uint8_t>;

/// One point a line.
std::expected<Bytes, std::string> ascii_points(const PointFile& file, std::string_view text) {
  Bytes bytes, point(file.step);
  std::uint64_t read = 0;
  for (std::size_t line = file.lines + 1; read < file.points; ++line) {
    const auto content = take_line(text);
    if (!content) return wrong("expected ", file.points, " points, got ", read);
    const Words words = words_of(*content);
    if (words.empty()) continue;
    if (const auto written = put_point(file, words, point.data()); !written)
      return wrong("line ", line, ": ", written.error());
    bytes.insert(bytes.end(), point.begin(), point.end());
    ++read;
  }
  return bytes;
}

std::expected<Bytes, std::string> binary_points(const PointFile& file, std::string_view bytes) {
  if (file.points > bytes.size() / file.step) {
    return wrong("expected ", file.points, " points of ", file.step, " bytes, got ", bytes.size(), " bytes");
  }
  const std::string_view points = bytes.substr(0, file.points * file.step);
  return Bytes(points.begin(), points.end());
}

/// Whether the point is a place.
bool is_place(const std::vector<CloudField>& fields, const std::uint8_t* point) {
  const auto is_finite = [](auto value, const std::uint8_t* at) {
    std::memcpy(&value, at, sizeof value);
    return std::isfinite(value);
  };
  return std::ranges::all_of(fields, [&](const CloudField& field) {
    if (field.name != "x" && field.name != "y" && field.name != "z") return true;
    const std::uint8_t* const at = point + field.offset;
    return field.datatype == kFloat32 ? is_finite(0.0F, at) : is_finite(0.0, at);
  });
}

/// The cloud of `header` and `rest`, without padding and non-places (the ICD's clouds are dense, 6.3.2).
std::expected<Cloud, std::string> cloud_of(const PointFile& header, std::string_view rest) {
  ADIT_TRY(check_fields(header.fields));
  const Bytes bytes = ADIT_TRY(header.is_ascii ? ascii_points(header, rest) : binary_points(header, rest));
  Cloud cloud{.origin = header.origin, .fields = header.fields, .point_step = header.step};
  std::erase_if(cloud.fields, [](const CloudField& field) { return field.name == kPadding; });
  for (auto point = bytes.begin(); point != bytes.end(); point += header.step) {
    if (is_place(header.fields, &*point)) cloud.data.insert(cloud.data.end(), point, point + header.step);
  }
  return cloud;
}

using PcdEntries = std::map<std::string_view, Words>;

Done read_pcd_fields(PcdEntries& entries, PointFile& file) {
  constexpr std::uint32_t kMostValues = 4096;
  constexpr std::size_t kMostFields = 256;
  const Words &names = entries["FIELDS"], &sizes = entries["SIZE"], &types = entries["TYPE"];
  Words& counts = entries["COUNT"];
  if (counts.empty()) counts.assign(names.size(), "1");
  if (names.empty() || sizes.size() != names.size() || types.size() != names.size() ||
      counts.size() != names.size())
    return wrong("FIELDS, SIZE, TYPE and COUNT: expected as many entries in each");
  if (names.size() > kMostFields) return wrong("FIELDS: expected at most 256");
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string field = icd::sentence("field '", names[i], "': ");
    const int datatype = datatype_of(icd::sentence(types[i], sizes[i]));
    if (datatype == 0)
      return wrong(field, "a point cloud message has no type for TYPE ", types[i], " of SIZE ", sizes[i]);
    const auto count = parse_number<std::uint32_t>(counts[i]);
    if (!count || *count < 1 || *count > kMostValues)
      return wrong(field, "expected a COUNT from 1 to 4096, got '", counts[i], "'");
    file.add_field(names[i], datatype, *count);
  }
  return {};
}

/// VIEWPOINT: tx ty tz qw qx qy qz.
std::expected<std::optional<Placement>, std::string> viewpoint_of(const Words& words) {
  if (words.empty()) return std::nullopt;
  const auto v = numbers_of(words);
  if (!v || v->size() != 7) return wrong("VIEWPOINT: expected 7 numbers");
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
    if (!line || ++file.lines > kMostLines) return wrong("not a PCD file: the header has no DATA line");
    const Words words = words_of(*line);
    if (!words.empty() && !words[0].starts_with('#')) entries[words[0]] = {words.begin() + 1, words.end()};
  }
  ADIT_TRY(read_pcd_fields(entries, file));
  const auto number = [&](std::string_view name) {
    const Words& words = entries[name];
    return words.size() == 1 ? parse_number<std::uint32_t>(words[0]) : std::nullopt;
  };
  const auto points = number("POINTS"), width = number("WIDTH"), height = number("HEIGHT");
  if (!points && !(entries["POINTS"].empty() && width && height))
    return wrong("POINTS: expected a whole number");
  file.points = points ? *points : std::uint64_t{*width} * *height;
  file.origin = ADIT_TRY(viewpoint_of(entries["VIEWPOINT"]));
  const std::string_view form = entries["DATA"].empty() ? "" : entries["DATA"][0];
  file.is_ascii = form == "ascii";
  if (file.is_ascii || form == "binary") return file;
  const bool is_compressed = form == "binary_compressed";
  return wrong("DATA: expected ascii or binary, got '", form,
               is_compressed ? "': convert it with pcl_convert_pcd_ascii_binary" : "'");
}

/// What a PLY's header said so far.
struct PlyHeader {
  PointFile file;
  std::string format;
  std::optional<std::uint64_t> vertices;
  bool in_vertex = false;

  Done element(const Words& words) {
    in_vertex = words.size() == 3 && words[1] == "vertex";
    if (!in_vertex && !vertices) return wrong("expected the first element to be vertex");
    if (!in_vertex) return {};
    if (vertices) return wrong("element vertex is given twice");
    vertices = parse_number<std::uint32_t>(words[2]);
    if (vertices) return {};
    return wrong("element vertex: expected a whole number, got '", words[2], "'");
  }

  Done property(const Words& words) {
    if (!in_vertex) return {};
    const int datatype = words.size() == 3 ? datatype_of(std::string(words[1])) : 0;
    if (datatype == 0)
      return wrong("property ", words.back(), " of vertex: expected a single value of a known type");
    file.add_field(words[2], datatype, 1);
    return {};
  }
};

std::expected<PointFile, std::string> take_ply_header(std::string_view& rest) {
  constexpr std::size_t kMostLines = 1000;
  if (icd::trim(icd::cut(rest, '\n')) != "ply") return wrong("not a PLY file: the first line is not 'ply'");
  PlyHeader header;
  header.file.lines = 1;
  for (Words words; words.empty() || words[0] != "end_header";) {
    const auto line = take_line(rest);
    if (!line || ++header.file.lines > kMostLines)
      return wrong("not a PLY file: the header has no end_header");
    words = words_of(*line);
    if (words.empty()) continue;
    if (words[0] == "format" && words.size() >= 2) header.format = words[1];
    if (words[0] == "element") ADIT_TRY(header.element(words));
    if (words[0] == "property") ADIT_TRY(header.property(words));
  }
  if (!header.vertices) return wrong("no element vertex");
  header.file.points = *header.vertices;
  header.file.is_ascii = header.format == "ascii";
  if (header.file.is_ascii || header.format == "binary_little_endian") return header.file;
  return wrong("format: expected ascii or binary_little_endian, got '", header.format, "'");
}

std::string_view unquote(std::string_view text) {
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

/// A PGM header's next word: comments may go before it.
std::string_view take_pgm_word(std::string_view& rest) {
  while (icd::trim(rest).starts_with('#')) {
    rest.remove_prefix(rest.find('#'));
    icd::cut(rest, '\n');
  }
  return take_word(rest);
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

namespace fs = std::filesystem;

std::expected<MapYaml, std::string> load_yaml(const fs::path& file) {
  const auto text = read_file(file);
  auto yaml = text ? parse_map_yaml(*text) : std::unexpected(text.error());
  if (!yaml) return wrong(file.filename().string(), ": ", yaml.error());
  return yaml;
}

/// The YAML of the PGM's own name; else one in its folder whose `image` is the PGM; else the defaults.
std::expected<MapYaml, std::string> find_yaml(const fs::path& pgm) {
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
  const MapYaml yaml = ADIT_TRY(find_yaml(file));
  return parse_pgm(bytes, yaml);
}

}  // namespace

std::expected<Cloud, std::string> parse_pcd(std::string_view bytes) {
  const PointFile header = ADIT_TRY(take_pcd_header(bytes));
  return cloud_of(header, bytes);
}

std::expected<Cloud, std::string> parse_ply(std::string_view bytes) {
  const PointFile header = ADIT_TRY(take_ply_header(bytes));
  return cloud_of(header, bytes);
}

std::expected<MapYaml, std::string> parse_map_yaml(std::string_view text) {
  std::map<std::string_view, std::string_view> members;
  while (!text.empty()) {
    const std::string_view line = icd::cut(text, '\n');
    std::string_view content = line.starts_with('#') ? "" : line.substr(0, line.find(" #"));
    if (!content.contains(':')) continue;  // blank, "---"
    const std::string_view name = icd::trim(icd::cut(content, ':'));
    members[name] = unquote(icd::trim(content));
  }
  std::string fault;  // the first
  const auto complain = [&](const std::string& key, const char* expected) {
    if (!fault.empty()) return;
    fault = icd::sentence(key, ": expected ", expected, ", got '",
                          members.contains(key) ? members[key] : "nothing", "'");
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
  if (!fault.empty()) return wrong(fault);
  return yaml;
}

std::expected<Grid, std::string> parse_pgm(std::string_view bytes, const MapYaml& yaml) {
  constexpr std::uint32_t kLongestSide = 100'000;
  if (const std::string_view magic = take_pgm_word(bytes); magic != "P5")
    return wrong("expected a binary PGM (P5), got '", magic.substr(0, 20), "'");
  std::uint32_t width = 0, height = 0, white = 0;
  for (const auto& [number, what, most] : {std::tuple{&width, "width", kLongestSide},
                                           {&height, "height", kLongestSide},
                                           {&white, "largest grey", 255}}) {
    const std::string_view word = take_pgm_word(bytes);
    *number = parse_number<std::uint32_t>(word).value_or(0);
    if (*number >= 1 && *number <= most) continue;
    return wrong(what, ": expected a number from 1 to ", most, ", got '", word.substr(0, 20), "'");
  }
  bytes.remove_prefix(std::min<std::size_t>(1, bytes.size()));  // exactly one blank ends the header

  const std::size_t size = std::size_t{width} * height;
  if (bytes.size() < size)
    return wrong("expected ", width, " x ", height, " = ", size, " cells, got ", bytes.size());
  Grid grid{.resolution = yaml.resolution,
            .width = width,
            .height = height,
            .origin = {.position = {yaml.x, yaml.y, 0}, .orientation = rotation_of(yaml.yaw)}};
  const auto cells = trinary(white, yaml);
  for (std::size_t row = height; row-- > 0;) {
    for (const char grey : bytes.substr(row * width, width))
      grid.cells.push_back(cells[static_cast<std::uint8_t>(grey)]);
  }
  return grid;
}

std::expected<LoadedMap, std::string> load_map(const fs::path& file) {
  const auto bytes = read_file(file);
  auto map = bytes ? parse(file, *bytes) : std::unexpected(bytes.error());
  if (!map) return wrong(file.string(), ": ", map.error());
  if (const Cloud* cloud = std::get_if<Cloud>(&*map); cloud != nullptr && cloud->data.empty())
    return wrong(file.string(), ": the file has no points");
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
  if (error) return wrong(folder.string(), ": ", error.message());
  std::ranges::sort(files);
  return files;
}

}  // namespace adit::robots
