#include "rehearsal/command_post/record.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>
#include <iterator>
#include <numeric>
#include <set>
#include <span>
#include <sstream>
#include <string_view>

#include "icd/sentence.hpp"
#include "rehearsal/common.hpp"

namespace adit::rehearsal {
namespace {

constexpr std::size_t kMostParts = 1000;
constexpr std::size_t kMostFaults = 1000;
constexpr std::size_t kMostReports = 10'000;
constexpr std::size_t kMostViolations = 200;
constexpr std::size_t kLongest = 200;  // characters of a name or sentence
constexpr const char* kOthers = "(others)";

/// Robots' names come from the wire: nothing of them may steer a terminal.
std::string printable(const std::string& text) {
  std::string safe = text.substr(0, kLongest);
  for (char& c : safe) {
    if (c < 0x20 || c == 0x7f) c = '?';
  }
  return safe;
}

char type_letter(int datatype) {
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
    const std::string name = sanitize(field.name);
    return name.empty() ? "_" : name;
  });
  write_words(file, "SIZE", cloud.fields, [](const auto& field) { return size_of_datatype(field.datatype); });
  write_words(file, "TYPE", cloud.fields, [](const auto& field) { return type_letter(field.datatype); });
  write_words(file, "COUNT", cloud.fields, [](const auto& field) { return field.count; });
  const Placement origin = cloud.origin.value_or(Placement{});
  const auto& [at, turn] = origin;
  file << icd::sentence("WIDTH ", points, "\nHEIGHT 1\nVIEWPOINT ", at.x, " ", at.y, " ", at.z, " ", turn.w,
                        " ", turn.x, " ", turn.y, " ", turn.z, "\nPOINTS ", points, "\nDATA binary\n");
}

/// Writes the `count` values of a field in little-endian order.
void write_values(std::ofstream& file, const char* value, const CloudField& field, bool bigendian) {
  const std::size_t size = size_of_datatype(field.datatype);
  if (!bigendian) {
    file.write(value, static_cast<std::streamsize>(size * field.count));
    return;
  }
  for (std::uint32_t i = 0; i < field.count; ++i, value += size) {
    std::reverse_copy(value, value + size, std::ostreambuf_iterator(file));
  }
}

/// Writes `stem`.pcd (PCD v0.7, binary): the message's fields without gaps, little-endian, its origin as the
/// VIEWPOINT, without bytes after the last whole point. False: the disk did not take it.
bool write_cloud(const Cloud& cloud, const std::string& data, const std::string& stem) {
  const std::size_t points = data.size() / cloud.point_step;
  std::ofstream file(stem + ".pcd", std::ios::binary);
  write_header(file, cloud, points);
  for (std::size_t i = 0; i < points && file; ++i) {
    for (const CloudField& field : cloud.fields)
      write_values(file, data.data() + i * cloud.point_step + field.offset, field, cloud.is_bigendian);
  }
  file.close();
  return !file.fail();
}

/// How many bytes the picture of a map will take on the disk, about.
std::size_t picture_size(const MapMessage& map) {
  constexpr std::size_t headers = 1024;
  const auto* const cloud = std::get_if<Cloud>(&map.msg);
  if (cloud == nullptr) return map.data.size() + headers;
  const std::size_t header = headers + cloud->fields.size() * 64;
  return header + map.data.size() / cloud->point_step * packed_size(*cloud);
}

char grey_of(char cell) {
  const auto value = static_cast<unsigned char>(cell);
  if (value == kUnknown) return static_cast<char>(205);
  if (value > 100) return static_cast<char>(255);  // no value of the ICD's
  return static_cast<char>(254 - (254 * value + 50) / 100);
}

double yaw_of(const Rotation& q) {
  return std::atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z));
}

/// Writes `stem`.pgm as ROS's map_saver draws it (254 free to 0 occupied, 205 unknown, a grey for each value
/// from 0 to 100, first row at the bottom) and `stem`.yaml. False: the disk did not take it.
bool write_grid(const Grid& grid, const std::string& cells, const std::string& stem) {
  std::ofstream picture(stem + ".pgm", std::ios::binary), yaml(stem + ".yaml");
  picture << "P5\n" << grid.width << ' ' << grid.height << "\n255\n";
  std::string row(grid.width, '\0');
  for (std::size_t y = grid.height; y-- > 0;) {
    std::ranges::transform(std::string_view(cells).substr(y * grid.width, grid.width), row.begin(), grey_of);
    picture << row;
  }
  const Vector3& at = grid.origin.position;
  yaml << icd::sentence("image: ", stem.substr(stem.rfind('/') + 1), ".pgm\nresolution: ", grid.resolution,
                        "\norigin: [", at.x, ", ", at.y, ", ", yaw_of(grid.origin.orientation),
                        "]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
  picture.close();
  yaml.close();
  return !picture.fail() && !yaml.fail();
}

std::uint64_t lines_in(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return static_cast<std::uint64_t>(
      std::count(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>(), '\n'));
}

std::string stem_of(std::uint64_t number, const MapMessage& map) {
  const std::string digits = std::to_string(number);
  const std::size_t zeros = 6 - std::min<std::size_t>(6, digits.size());
  return icd::sentence(std::string(zeros, '0'), digits, "-",
                       map.name.empty() ? "merged" : sanitize(map.name));
}

/// Replaces long texts and lists of a document by their sizes, so that a line of it can be read.
void shorten(Json& value) {
  constexpr std::size_t longest_text = 4096;
  constexpr std::size_t longest_list = 10'000;
  if (value.is_binary()) {
    value = {{"bytes", value.get_binary().size()}};
  } else if (value.is_string() && value.get_ref<const std::string&>().size() > longest_text) {
    value = {{"characters", value.get_ref<const std::string&>().size()}};
  } else if (value.is_structured() && value.size() > longest_list) {
    value = {{"elements", value.size()}};
  } else if (value.is_structured()) {
    for (Json& element : value) shorten(element);
  }
}

OrderedJson or_null(bool is_there, const auto& value) {
  return is_there ? OrderedJson(value) : OrderedJson(nullptr);
}

}  // namespace

void Record::note(std::uint64_t number, const Judgement& judgement) {
  const std::lock_guard lock(mutex_);
  const bool answered = judgement.outcome.kind == Outcome::Kind::Answered;
  const std::string uri = judgement.uri.empty() ? kOthers : judgement.uri;
  ++requests_[{uri, answered ? judgement.outcome.answer.status : 0}];
  for (const auto& [kind, robot] : judgement.accepted.parts)
    count_bounded(accepted_, {uri, kind, robot.substr(0, kLongest)}, {uri, kind, kOthers}, kMostParts);
  if (!judgement.fault.empty()) count_bounded(faults_, {uri, judgement.fault}, {uri, kOthers}, kMostFaults);
  for (std::string& sentence : judgement.findings.violations()) {
    ++violation_count_;
    if (violations_.size() < kMostViolations) violations_.push_back({number, uri, std::move(sentence)});
  }
  if (judgement.outcome.kind == Outcome::Kind::Dies && killed_by_.empty()) {
    killed_by_ = judgement.findings.first_rejected(Manner::AsMeasured)->sentence;
  }
}

void Record::note_report(const OrderedJson& report) {
  const auto id_of = [](const OrderedJson& one) { return one["id"].get<std::int64_t>(); };
  const std::lock_guard lock(mutex_);
  ++report_count_;
  auto place = reports_.end();
  while (place != reports_.begin() && id_of(*std::prev(place)) > id_of(report)) --place;
  reports_.insert(place, report);
  if (reports_.size() > kMostReports) reports_.pop_front();
}

std::string Record::killed_by() const {
  const std::lock_guard lock(mutex_);
  return killed_by_;
}

OrderedJson Record::json(const Run::Standing& standing) const {
  const std::lock_guard lock(mutex_);
  OrderedJson requests = OrderedJson::array();
  for (const auto& [key, count] : requests_) {
    requests.push_back({{"uri", key.first}, {"status", key.second}, {"count", count}});
  }
  OrderedJson accepted = OrderedJson::array();
  for (const auto& [part, count] : accepted_) {
    const auto& [uri, kind, robot] = part;
    accepted.push_back({{"uri", uri}, {"kind", kind}, {"robot", robot}, {"count", count}});
  }
  OrderedJson faults = OrderedJson::array();
  for (const auto& [key, count] : faults_) {
    faults.push_back({{"uri", key.first}, {"fault", key.second}, {"count", count}});
  }
  OrderedJson first = OrderedJson::array();
  for (const Violation& violation : violations_) {
    first.push_back(
        {{"request", violation.number}, {"uri", violation.uri}, {"sentence", violation.sentence}});
  }
  return {{"manner", manner_ == Manner::Strict ? "strict" : "as measured"},
          {"team", standing.team},
          {"run", standing.run},
          {"state", standing.state},
          {"run_clock", standing.clock},
          {"score", standing.score},
          {"remaining_reports", standing.remaining_reports},
          {"requests", requests},
          {"accepted", accepted},
          {"faults", faults},
          {"report_count", report_count_},
          {"reports", reports_},
          {"violation_count", violation_count_},
          {"violations", first},
          {"killed_by", killed_by_.empty() ? OrderedJson() : OrderedJson(killed_by_)}};
}

std::string Record::summary(const Run::Standing& standing) const {
  constexpr std::size_t most_lines = 50;
  const std::lock_guard lock(mutex_);
  std::ostringstream out;
  out << "summary: team " << standing.team << ", run " << standing.run << ", " << standing.state
      << ", run clock " << standing.clock << " s\n";
  for (const auto& [key, count] : requests_) {
    out << "  " << key.first << ": " << (key.second == 0 ? "not answered" : std::to_string(key.second))
        << " x " << count << "\n";
  }
  out << "accepted\n";
  for (const auto& [part, count] : accepted_) {
    const auto& [uri, kind, robot] = part;
    out << "  " << kind << " " << (robot.empty() ? "-" : printable(robot)) << ": " << count << "\n";
  }
  out << "reports: " << report_count_ << ", score " << standing.score << ", " << standing.remaining_reports
      << " remaining\n";
  const std::size_t skipped = reports_.size() > most_lines ? reports_.size() - most_lines : 0;
  for (std::size_t i = skipped; i < reports_.size(); ++i) {
    const OrderedJson& report = reports_[i];
    out << "  #" << report["id"] << " at " << report["run_clock"]
        << " s: " << printable(line_of(report["type"])) << " (" << printable(line_of(report["x"])) << ", "
        << printable(line_of(report["y"])) << ", " << printable(line_of(report["z"])) << ") "
        << report["report_status"].get<std::string>() << ", " << report["score_change"]
        << (report["by"] == kByOther ? ", by another sender\n" : "\n");
  }
  if (!faults_.empty()) out << "requested faults\n";
  for (const auto& [key, count] : faults_) {
    out << "  " << key.first << ": " << key.second << " (" << count << " times)\n";
  }
  out << "violations of the ICD: " << violation_count_ << "\n";
  std::map<std::pair<std::string, std::string>, std::uint64_t> alike;
  for (const Violation& violation : violations_) ++alike[{violation.uri, violation.sentence}];
  for (const auto& [what, count] : alike) {
    out << "  " << what.first << ": " << printable(what.second) << " (" << count << " times)\n";
  }
  if (!killed_by_.empty()) out << "killed by " << printable(killed_by_) << "\n";
  return out.str();
}

std::expected<std::unique_ptr<Transcript>, std::string> Transcript::open(const std::string& folder,
                                                                         std::uint64_t most) {
  std::unique_ptr<Transcript> transcript(new Transcript(folder, most));
  std::error_code error;
  for (const char* const kind : {"grids", "clouds"}) {
    std::filesystem::create_directories(std::filesystem::path(folder) / kind, error);
    if (error) return std::unexpected(folder + "/" + kind + ": " + error.message());
  }
  const std::string requests = folder + "/requests.jsonl";
  transcript->requests_ = lines_in(requests);
  transcript->requests_file_.open(requests, std::ios::binary | std::ios::app);
  transcript->reports_file_.open(folder + "/reports.jsonl", std::ios::binary | std::ios::app);
  if (!transcript->requests_file_ || !transcript->reports_file_) {
    return std::unexpected(folder + ": cannot be written");
  }
  return transcript;
}

std::optional<std::string> Transcript::picture(std::uint64_t number, const MapMessage& map) {
  const std::size_t size = picture_size(map);
  {
    const std::lock_guard lock(mutex_);
    if (written_ + size > most_) return std::nullopt;
    written_ += size;
  }
  const auto* const grid = std::get_if<Grid>(&map.msg);
  const std::string stem = (grid != nullptr ? "grids/" : "clouds/") + stem_of(number, map);
  const std::string path = folder_ + "/" + stem;
  const bool good = grid != nullptr ? write_grid(*grid, map.data, path)
                                    : write_cloud(std::get<Cloud>(map.msg), map.data, path);
  if (!good) return std::nullopt;
  return stem + (grid != nullptr ? ".pgm" : ".pcd");
}

void Transcript::request(std::uint64_t number, const char* endpoint, const Request& request,
                         Judgement& judgement) {
  constexpr std::size_t longest_message = std::size_t{1} << 20;
  OrderedJson message;
  if (judgement.message) {
    if (judgement.accepted.map) {
      const auto file = picture(number, *judgement.accepted.map);
      (*judgement.message)["msg"]["data"]["file"] = file ? Json(*file) : Json(nullptr);
    }
    shorten(*judgement.message);
    message = *judgement.message;
    const std::size_t length = line_of(message).size();
    if (length > longest_message) message = {{"characters", length}};
  }
  const Outcome& outcome = judgement.outcome;
  const bool answered = outcome.kind == Outcome::Kind::Answered && outcome.answer.status != 0;
  const OrderedJson line = {
      {"number", number},
      {"at", std::chrono::duration<double>(request.at - opened_).count()},
      {"endpoint", endpoint},
      {"method", request.method},
      {"uri", request.target},
      {"content_type", or_null(request.content_type.has_value(), request.content_type.value_or(""))},
      {"content_encoding",
       or_null(request.content_encoding.has_value(), request.content_encoding.value_or(""))},
      {"expect", request.expects_continue},
      {"authorization", request.authorization.has_value()},
      {"body_bytes", request.body.size()},
      {"status", or_null(answered, outcome.answer.status)},
      {"answer", or_null(answered, outcome.answer.body)},
      {"message", std::move(message)},
      {"fault", or_null(request.fault.has_value(), request.fault.value_or(HttpFault{}).sentence)},
      {"rehearsed_fault", or_null(!judgement.fault.empty(), judgement.fault)},
      {"violations", judgement.findings.violations()}};
  append(requests_file_, line);
}

void Transcript::append(std::ofstream& file, const OrderedJson& line) {
  const std::string text = line_of(line) + "\n";
  const std::lock_guard lock(mutex_);
  written_ += text.size();
  file << text << std::flush;
  if (file || complained_) return;
  complained_ = true;
  file.clear();
  std::fprintf(stderr, "adit-rehearsal: %s: cannot write a line; the disk may be full\n", folder_.c_str());
}

namespace {

using Milliseconds = std::chrono::milliseconds;

constexpr std::int64_t kModulus = kDateBase * kDateBase * kDateBase * kDateBase * kDateBase;

/// When a map's data was posted, as adit-robots writes it into its maps (README.md, 'How old').
struct Dates {
  Moment newest;
  // Of a cloud: how many different points were posted then. A merged cloud may have some twice.
  std::map<Moment, std::uint64_t> points;
};

/// The moment nearest to `now` whose milliseconds since 1970 are `value` modulo `modulus`.
Moment nearest(std::int64_t value, std::int64_t modulus, Moment now) {
  std::int64_t before = (now.time_since_epoch().count() - value) % modulus;
  if (before > modulus / 2) before -= modulus;
  if (before < -modulus / 2) before += modulus;
  return now - Milliseconds(before);
}

std::optional<Dates> dates_of_grid(std::string_view cells, Moment now) {
  std::optional<Dates> dates;
  for (std::size_t at = cells.find(kDateFollows); at != std::string_view::npos;
       at = cells.find(kDateFollows, at + 1)) {
    const std::string_view digits = cells.substr(at + kDateFollows.size(), kDateDigits);
    if (digits.size() < kDateDigits) break;
    std::int64_t value = 0;
    for (const char digit : digits) value = value * kDateBase + static_cast<unsigned char>(digit);
    const Moment posted = nearest(value, kModulus, now);
    if (!dates || posted > dates->newest) dates = {.newest = posted, .points = {}};
  }
  return dates;
}

/// Each point once, in whatever order they are: its date, which stands at `offset`, and a hash of all of it.
std::vector<std::pair<std::uint32_t, std::size_t>> different_points(const Cloud& cloud, std::string_view data,
                                                                    std::size_t offset) {
  std::vector<std::pair<std::uint32_t, std::size_t>> points;
  points.reserve(data.size() / cloud.point_step);
  for (; data.size() >= cloud.point_step; data.remove_prefix(cloud.point_step)) {
    const std::string_view point = data.substr(0, cloud.point_step);
    std::uint32_t posted = 0;
    std::memcpy(&posted, point.data() + offset, sizeof posted);
    points.emplace_back(posted, std::hash<std::string_view>{}(point));
  }
  std::ranges::sort(points);
  const auto repeated = std::ranges::unique(points);
  points.erase(repeated.begin(), repeated.end());
  return points;
}

std::optional<Dates> dates_of_cloud(const Cloud& cloud, std::string_view data, Moment now) {
  const auto field = std::ranges::find(cloud.fields, "posted_ms", &CloudField::name);
  if (field == cloud.fields.end() || field->datatype != kUint32 || cloud.is_bigendian) return std::nullopt;
  const auto points = different_points(cloud, data, field->offset);
  if (points.empty()) return std::nullopt;
  std::map<std::uint32_t, std::uint64_t> counts;
  for (const auto& [posted, point] : points) ++counts[posted];
  Dates dates;
  for (const auto& [posted, count] : counts) {
    dates.points[nearest(posted, std::int64_t{1} << 32, now)] += count;
  }
  dates.newest = dates.points.rbegin()->first;
  return dates;
}

/// Nothing of a map that tells no date. A date is read as the one nearest to `now`.
std::optional<Dates> dates_of(const MapMessage& map, Moment now) {
  const auto* const cloud = std::get_if<Cloud>(&map.msg);
  return cloud != nullptr ? dates_of_cloud(*cloud, map.data, now) : dates_of_grid(map.data, now);
}

constexpr int kDelete = 2, kDeleteAll = 3;
constexpr std::size_t kMostMarkers = 100'000, kMostRobots = 1000, kMostDifferences = 20;
constexpr double kSamePlace = 1e-3;  // metres: some robots post float32

constexpr std::size_t kMostSources = 200;
constexpr std::size_t kMostDates = 100'000;  // of one robot's points
constexpr Milliseconds kTick{10};            // the resolution of ages
constexpr Milliseconds kOldest{3'600'000};
constexpr std::size_t kColumn = 8;  // characters

double share_of(std::uint64_t part, std::uint64_t all) {
  return all == 0 ? 1 : static_cast<double>(part) / static_cast<double>(all);
}

double seconds(Milliseconds time) {
  return std::chrono::duration<double>(time).count();
}

/// "12.3", or "-" without a value.
std::string decimal_text(const OrderedJson& value, int digits) {
  if (value.is_null()) return "-";
  std::array<char, 32> text{};
  (void)std::snprintf(text.data(), text.size(), "%.*f", digits, value.get<double>());
  return text.data();
}

std::string percent(const OrderedJson& share) {
  return share.is_null() ? "-" : decimal_text(100 * share.get<double>(), 1) + "%";
}

}  // namespace

std::uint64_t Arrivals::ReceivedMaps::amount() const {
  const auto add = [](std::uint64_t sum, const auto& dated) { return sum + dated.second; };
  return cells.count() + std::accumulate(points.begin(), points.end(), std::uint64_t{0}, add);
}

double Arrivals::ReceivedMaps::age(double share) const {
  const double wanted = std::ceil(share * static_cast<double>(maps));
  std::uint64_t seen = 0;
  for (const auto& [age, count] : ages) {
    seen += count;
    if (static_cast<double>(seen) >= wanted) return seconds(age);
  }
  return 0;
}

Arrivals::ReceivedMaps* Arrivals::find_arrived(const std::string& robot, const std::string& kind) {
  const Source source{robot, kind};
  if (arrived_.size() >= kMostSources && !arrived_.contains(source)) return nullptr;
  return &arrived_[source];
}

void Arrivals::note(const MapMessage& map, Moment now) {
  const auto dates = dates_of(map, now);
  if (!dates) return;
  const std::lock_guard lock(mutex_);
  const auto* const grid = std::get_if<Grid>(&map.msg);
  ReceivedMaps* const here = find_arrived(map.name, grid != nullptr ? "grid" : "cloud");
  if (here == nullptr) return;
  ++here->maps;
  const auto age = std::chrono::floor<Milliseconds>(now - dates->newest);
  ++here->ages[std::clamp(age, Milliseconds(0), kOldest) / kTick * kTick];
  here->newest = std::max(here->newest, dates->newest);
  for (const auto& [date, points] : dates->points) {
    if (here->points.size() >= kMostDates && !here->points.contains(date)) continue;
    here->points[date] = std::max(here->points[date], points);
  }
  const std::span data(reinterpret_cast<const std::uint8_t*>(map.data.data()), map.data.size());
  if (const auto* const cloud = std::get_if<Cloud>(&map.msg)) {
    const Vector3 from = cloud->origin.value_or(Placement{}).position;
    return here->places.add(cloud->fields, cloud->point_step, data, {from.x, from.y, from.z});
  }
  const Vector3& corner = grid->origin.position;
  here->cells.add(grid->resolution, corner.x, corner.y, grid->width, data);
}

void Arrivals::note(const std::vector<MarkerChange>& changes, Findings& findings) {
  if (changes.empty()) return;
  const std::lock_guard lock(mutex_);
  for (const MarkerChange& change : changes) {
    const Key key{change.ns, change.id};
    if (change.action == kDeleteAll) standing_.clear();
    if (change.action == kDelete) standing_.erase(key);
    if (change.action == 0 && (standing_.size() < kMostMarkers || standing_.contains(key)))
      standing_[key] = change.x;
  }
  for (std::size_t id = changes.size(); id < before_; ++id) {
    if (standing_.erase({"", static_cast<std::int64_t>(id)}) == 0) continue;
    findings.add_remark(
        icd::sentence("markers: the organiser's display deletes id ", id,
                      " of an empty ns because this message has fewer markers than the previous one"));
  }
  before_ = changes.size();
}

bool Arrivals::read_map_row(const Field& row) {
  const auto robot = row.text("robot"), kind = row.text("kind");
  const auto amount = row.integer("amount", 0, INT64_MAX), newest = row.integer("newest", 0, INT64_MAX);
  const auto told_places = row.optional_member("places");
  const auto places = told_places ? told_places->integer(0, INT64_MAX) : 0;
  if (!robot || !kind || !amount || !newest || !places) return false;
  if (ReceivedMaps* const here = find_arrived(*robot, *kind)) {
    here->posted = {.amount = static_cast<std::uint64_t>(*amount),
                    .places = static_cast<std::uint64_t>(*places),
                    .newest = Moment(Milliseconds(*newest))};
  }
  return true;
}

bool Arrivals::read_marker_row(const Field& row, const Field& standing) {
  const auto robot = row.text("robot");
  const auto markers = standing.elements();
  if (!robot || !markers || (should_.size() >= kMostRobots && !should_.contains(*robot))) return false;
  Places& places = should_[*robot] = {};
  for (const Field& marker : *markers) {
    const auto ns = marker.text("ns");
    const auto id = marker.integer("id", INT32_MIN, INT32_MAX);
    const auto x = marker.number("x");
    if (ns && id && x && places.size() < kMostMarkers) places[{*ns, *id}] = *x;
  }
  return true;
}

std::expected<void, std::string> Arrivals::set_expected(const Json& posted) {
  Findings findings;
  const auto rows = Field(posted, "", findings).elements().value_or(std::vector<Field>{});
  const std::lock_guard lock(mutex_);
  for (const Field& row : rows) {
    const auto standing = row.optional_member("standing");
    if (!(standing ? read_marker_row(row, *standing) : read_map_row(row))) break;
  }
  if (findings.all().empty()) return {};
  return std::unexpected(findings.all().front().sentence);
}

/// Between what stands and what should.
std::vector<std::string> Arrivals::differences() const {
  std::vector<std::string> all;
  std::set<std::string> told;  // namespaces of which some robot has told
  Places should;
  for (const auto& [robot, places] : should_) {
    for (const auto& [key, x] : places) told.insert(key.first);
    should.insert(places.begin(), places.end());
  }
  const auto text = [](const Key& key) { return icd::sentence("marker ", key.second, " of ", key.first); };
  for (const auto& [key, x] : should) {
    const auto found = standing_.find(key);
    if (found == standing_.end()) {
      all.push_back(text(key) + " is missing");
    } else if (std::abs(found->second - x) > kSamePlace) {
      all.push_back(text(key) + " is at x " + std::to_string(found->second) + ", not " + std::to_string(x));
    }
  }
  for (const auto& [key, x] : standing_) {
    if (told.contains(key.first) && !should.contains(key)) all.push_back(text(key) + " was deleted");
  }
  return all;
}

OrderedJson Arrivals::row(const Source& source, const ReceivedMaps& arrived) {
  OrderedJson row = {{"robot", source.first}, {"kind", source.second}, {"maps", arrived.maps}};
  const bool any = arrived.maps > 0;
  for (const auto& [name, share] : {std::pair{"p50", 0.5}, {"p99", 0.99}, {"most", 1.0}}) {
    row[name] = any ? OrderedJson(arrived.age(share)) : OrderedJson(nullptr);
  }
  row["behind"] = row["posted"] = row["share"] = row["places"] = nullptr;
  row["arrived"] = arrived.amount();
  if (!arrived.posted) return row;
  const auto& [amount, places, newest] = *arrived.posted;
  if (any) row["behind"] = std::max(0.0, seconds(newest - arrived.newest));
  row["posted"] = amount;
  row["share"] = share_of(arrived.amount(), amount);
  if (places > 0) row["places"] = share_of(arrived.places.count(), places);
  return row;
}

OrderedJson Arrivals::json() const {
  const std::lock_guard lock(mutex_);
  OrderedJson rows = OrderedJson::array();
  for (const auto& [source, arrived] : arrived_) rows.push_back(row(source, arrived));
  std::size_t should = 0;
  for (const auto& [robot, places] : should_) should += places.size();
  std::vector<std::string> first = differences();
  const std::size_t count = first.size();
  first.resize(std::min(count, kMostDifferences));
  const OrderedJson markers = {
      {"here", standing_.size()}, {"posted", should}, {"difference_count", count}, {"differences", first}};
  return {{"maps", rows}, {"markers", markers}};
}

std::string Arrivals::table() const {
  const OrderedJson all = json(), &rows = all["maps"], &markers = all["markers"];
  std::string text;
  if (!rows.empty()) {
    text =
        "age of maps at their arrival, in seconds; share of the posted maps that arrived\n"
        "  robot      kind    maps      p50     p99    most  behind    here  places\n";
  }
  for (const OrderedJson& row : rows) {
    const std::string robot = row["robot"];
    std::array<char, 64> line{};
    (void)std::snprintf(line.data(), line.size(), "  %-10.10s %-6.6s %5llu ",
                        robot.empty() ? "(merged)" : sanitize(robot).c_str(),
                        row["kind"].get_ref<const std::string&>().c_str(),
                        static_cast<unsigned long long>(row["maps"].get<std::uint64_t>()));
    text += line.data();
    for (const char* const age : {"p50", "p99", "most", "behind"})
      text += aligned_right(decimal_text(row[age], 2), kColumn);
    for (const char* const share : {"share", "places"}) text += aligned_right(percent(row[share]), kColumn);
    text += "\n";
  }
  if (markers["posted"] == 0) return text;
  text += icd::sentence("markers: ", markers["here"].dump(), " displayed, the robots have ",
                        markers["posted"].dump(), "; ", markers["difference_count"].dump(), " differ\n");
  for (const OrderedJson& sentence : markers["differences"]) text += "  " + sentence.dump() + "\n";
  return text;
}

}  // namespace adit::rehearsal
