#include "rehearsal/robots/answer.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace adit::robots {
namespace {

using Json = nlohmann::json;

Json parse(std::string_view body) {
  return Json::parse(body, nullptr, /*allow_exceptions=*/false);
}

/// Reads members one by one and remembers the first that is wrong.
class Reader {
 public:
  explicit Reader(const Json& object) : object_(object) {
    if (!object.is_object()) wrong_ = "the answer is not a JSON object";
  }

  double number(const char* name) {
    const Json* value = find(name);
    if (value != nullptr && value->is_number()) return value->get<double>();
    complain(name, "a number");
    return 0;
  }

  std::string text(const char* name) {
    const Json* value = find(name);
    if (value != nullptr && value->is_string()) return value->get<std::string>();
    complain(name, "a string");
    return {};
  }

  bool has(const char* name) const { return find(name) != nullptr; }
  const std::string& wrong() const { return wrong_; }

 private:
  const Json* find(const char* name) const {
    if (!object_.is_object()) return nullptr;
    const auto found = object_.find(name);
    return found == object_.end() ? nullptr : &*found;
  }
  void complain(const char* name, const char* expected) {
    if (wrong_.empty()) wrong_ = std::string("the answer's '") + name + "' is not " + expected;
  }

  const Json& object_;
  std::string wrong_;
};

}  // namespace

std::string sentence_of(std::string_view body) {
  if (body.empty()) return "(empty body)";
  const Json json = parse(body);
  if (json.is_string()) return json.get<std::string>();
  if (json.is_object() && json.contains("detail") && json["detail"].is_string()) {
    return json["detail"].get<std::string>();
  }
  constexpr std::size_t kShown = 100;
  std::string line(body.substr(0, std::min(body.find('\n'), kShown)));
  std::ranges::replace_if(line, [](char c) { return c < ' ' || c > '~'; }, '?');
  return (json.is_discarded() ? "not JSON: " : "") + line;
}

std::expected<ReportAnswer, std::string> parse_report_answer(std::string_view body) {
  const Json json = parse(body);
  Reader reader(json);
  ReportAnswer answer{
      .type = reader.text("type"),
      .x = reader.number("x"),
      .y = reader.number("y"),
      .z = reader.number("z"),
      .run_clock = reader.number("run_clock"),
      .report_status = reader.text("report_status"),
      .score_change = static_cast<int>(std::clamp(reader.number("score_change"), -99.0, 99.0))};
  if (!reader.wrong().empty()) return std::unexpected(reader.wrong());
  return answer;
}

std::expected<std::string, std::string> parse_status_answer(std::string_view body) {
  const Json json = parse(body);
  Reader reader(json);
  const double score = reader.number("score");
  const double remaining = reader.number("remaining_reports");
  const double clock = reader.number(reader.has("run_clock") ? "run_clock" : "clock");  // ICD 5.1 has both
  if (!reader.wrong().empty()) return std::unexpected(reader.wrong());
  return "score " + std::to_string(std::llround(score)) + ", " + std::to_string(std::llround(remaining)) +
         " reports left, run clock " + std::to_string(std::llround(clock)) + " s";
}

}  // namespace adit::robots
