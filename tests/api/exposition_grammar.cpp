#include "api/exposition_grammar.hpp"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <regex>
#include <set>
#include <sstream>

namespace adit::api {
namespace {

const std::regex kHelp(R"(# HELP ([a-zA-Z_:][a-zA-Z0-9_:]*) ((?:[^\\]|\\\\|\\n)+))");
const std::regex kType(R"(# TYPE ([a-zA-Z_:][a-zA-Z0-9_:]*) (counter|gauge))");
/// A sample in the output of emptied().
const std::regex kSample(R"re(([a-zA-Z_:][a-zA-Z0-9_:]*)(\{(?:[a-zA-Z_][a-zA-Z0-9_]*="",?)+\})? ([^ ]+))re");
const std::regex kValue(R"(NaN|[+-]Inf|-?\d+(\.\d+)?(e[+-]?\d+)?)");

/// The line without the values of its labels, which may be long; "" if a value is not escaped correctly.
std::string emptied(const std::string& line) {
  std::string text;
  bool inside = false;
  for (std::size_t at = 0; at < line.size(); ++at) {
    if (inside && line[at] == '\\') {
      if (++at == line.size() || std::string_view("\\\"n").find(line[at]) == std::string_view::npos)
        return "";
    } else if (line[at] == '"') {
      inside = !inside;
      text += '"';
    } else if (!inside) {
      text += line[at];
    }
  }
  return inside ? "" : text;
}

class Reader {
 public:
  void read(const std::string& line) {
    std::smatch parts;
    const std::string form = emptied(line);
    if (std::regex_match(line, parts, kHelp)) {
      if (!helped_.insert(parts[1]).second) fault(line, "a second HELP");
      metric_ = parts[1];
    } else if (std::regex_match(line, parts, kType)) {
      if (parts[1] != metric_) fault(line, "TYPE does not follow its HELP");
      if (!types_.emplace(parts[1], parts[2]).second) fault(line, "a second TYPE");
      if ((parts[2] == "counter") != metric_.ends_with("_total"))
        fault(line, "only a counter ends in _total");
    } else if (std::regex_match(form, parts, kSample)) {
      sample(line, parts);
    } else {
      fault(line, "is not a line of the format");
    }
  }
  std::vector<std::string> faults;

 private:
  void sample(const std::string& line, const std::smatch& parts) {
    const std::string name = parts[1], labels = parts[2], value = parts[3];
    if (name != metric_ || !types_.contains(name)) fault(line, "stands apart from its HELP and TYPE");
    if (!std::regex_match(value, kValue)) fault(line, "is no number");
    if (types_[name] == "counter" && std::strtod(value.c_str(), nullptr) < 0) fault(line, "counts backward");
    if (!samples_.insert(line.substr(0, line.rfind(' '))).second) fault(line, "is there twice");
    if (labels.ends_with(",}")) fault(line, "ends its labels with a comma");
  }
  void fault(const std::string& line, const char* what) { faults.push_back("'" + line + "' " + what); }

  std::string metric_;
  std::set<std::string> helped_, samples_;
  std::map<std::string, std::string> types_;
};

}  // namespace

std::vector<std::string> faults_of(std::string_view text) {
  Reader reader;
  if (!text.ends_with('\n')) reader.faults.emplace_back("the last line does not end");
  std::istringstream lines{std::string(text)};
  for (std::string line; std::getline(lines, line);) reader.read(line);
  return reader.faults;
}

}  // namespace adit::api
