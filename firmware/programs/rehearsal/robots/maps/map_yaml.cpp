#include "rehearsal/robots/maps/map_yaml.hpp"

#include <cmath>
#include <map>
#include <optional>

#include "rehearsal/robots/maps/bytes.hpp"

namespace adit::robots {
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

}  // namespace adit::robots
