#include "rehearsal/command_post/record.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <sstream>

#include "rehearsal/command_post/pictures.hpp"

namespace adit::rehearsal {
namespace {

std::uint64_t lines_in(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return static_cast<std::uint64_t>(
      std::count(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>(), '\n'));
}

std::string stem_of(std::uint64_t number, const MapMessage& map) {
  char digits[32];
  const int length = std::snprintf(digits, sizeof digits, "%06llu", static_cast<unsigned long long>(number));
  return std::string(digits, static_cast<std::size_t>(length)) + "-" +
         (map.name.empty() ? "merged" : tame(map.name));
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

OrderedJson text_or_null(const std::optional<std::string>& text) {
  return text ? OrderedJson(*text) : nullptr;
}

}  // namespace

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
  const bool good = grid != nullptr ? write_grid_picture(*grid, map.data, path)
                                    : write_cloud_picture(std::get<Cloud>(map.msg), map.data, path);
  if (!good) return std::nullopt;
  return stem + (grid != nullptr ? ".pgm" : ".pcd");
}

void Transcript::request(std::uint64_t number, const char* endpoint, const Request& request,
                         Judgement& judgement) {
  constexpr std::size_t longest_message = std::size_t{1} << 20;
  OrderedJson message;
  if (judgement.message) {
    if (judgement.map) {
      const auto file = picture(number, *judgement.map);
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
      {"content_type", text_or_null(request.content_type)},
      {"content_encoding", text_or_null(request.content_encoding)},
      {"expect", request.expects_continue},
      {"authorization", request.authorization.has_value()},
      {"body_bytes", request.body.size()},
      {"status", answered ? OrderedJson(outcome.answer.status) : OrderedJson(nullptr)},
      {"answer", answered ? OrderedJson(outcome.answer.body) : OrderedJson(nullptr)},
      {"message", std::move(message)},
      {"fault", request.fault ? OrderedJson(request.fault->sentence) : OrderedJson(nullptr)},
      {"rehearsed_fault", judgement.fault.empty() ? OrderedJson(nullptr) : OrderedJson(judgement.fault)},
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

}  // namespace

void Record::note_part(const std::string& uri, const Accepted& part) {
  const Part key{uri, part.kind, part.robot.substr(0, kLongest)};
  const bool room = accepted_.size() < kMostParts || accepted_.contains(key);
  ++accepted_[room ? key : Part{uri, part.kind, kOthers}];
}

void Record::note(std::uint64_t number, const Judgement& judgement) {
  const std::lock_guard lock(mutex_);
  const bool answered = judgement.outcome.kind == Outcome::Kind::Answered;
  const std::string uri = judgement.uri.empty() ? kOthers : judgement.uri;
  ++requests_[{uri, answered ? judgement.outcome.answer.status : 0}];
  for (const Accepted& part : judgement.accepted) note_part(uri, part);
  if (!judgement.fault.empty()) {
    const std::pair key{uri, judgement.fault};
    const bool room = faults_.size() < kMostFaults || faults_.contains(key);
    ++faults_[room ? key : UriAndFault{uri, kOthers}];
  }
  for (std::string& sentence : judgement.findings.violations()) {
    ++violation_count_;
    if (violations_.size() < kMostViolations) violations_.push_back({number, uri, std::move(sentence)});
  }
  if (judgement.outcome.kind == Outcome::Kind::Dies && killed_by_.empty()) {
    killed_by_ = judgement.findings.decisive(Manner::AsMeasured)->sentence;
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

OrderedJson Record::counts() const {
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
  return {{"requests", requests}, {"accepted", accepted}, {"faults", faults}};
}

OrderedJson Record::json(const Run::Standing& standing) const {
  const std::lock_guard lock(mutex_);
  OrderedJson first = OrderedJson::array();
  for (const Violation& violation : violations_) {
    first.push_back(
        {{"request", violation.number}, {"uri", violation.uri}, {"sentence", violation.sentence}});
  }
  OrderedJson killed;
  if (!killed_by_.empty()) killed = killed_by_;
  OrderedJson record = {{"manner", manner_ == Manner::Strict ? "strict" : "as measured"},
                        {"team", standing.team},
                        {"run", standing.run},
                        {"state", standing.state},
                        {"run_clock", standing.clock},
                        {"score", standing.score},
                        {"remaining_reports", standing.remaining_reports}};
  record.update(counts());
  record.update({{"report_count", report_count_},
                 {"reports", reports_},
                 {"violation_count", violation_count_},
                 {"violations", first},
                 {"killed_by", killed}});
  return record;
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

}  // namespace adit::rehearsal
