#include "settings/keys.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include "codec/field.hpp"
#include "codec/json.hpp"
#include "icd/require.hpp"
#include "icd/robot_name.hpp"
#include "icd/sentence.hpp"
#include "icd/text.hpp"
#include "settings/subnet.hpp"

namespace adit::settings {
namespace {

bool is_address(const std::string& text) {
  if (text.find('\0') != std::string::npos) return false;
  in6_addr parsed{};
  return inet_pton(AF_INET, text.c_str(), &parsed) == 1 || inet_pton(AF_INET6, text.c_str(), &parsed) == 1;
}

/// Course names are parts of file names.
bool is_course(const std::string& text) {
  return is_word(text, 20);
}

/// At most `most` visible ASCII characters, without those in `without`.
bool is_name(const std::string& text, std::size_t most, std::string_view without = "") {
  if (text.size() > most || text.find_first_of(without) != std::string::npos) return false;
  for (const char c : text) {
    if (c < '!' || c > '~') return false;
  }
  return true;
}

bool are(std::string_view text, std::string_view others) {
  return std::ranges::all_of(text, [others](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || others.contains(c);
  });
}

bool is_port(std::string_view text) {
  return icd::number_in<std::uint16_t>(text) && text.front() != '0';
}

/// "http://10.0.0.20:3000", as a browser writes it (RFC 6454 6.2): in lower case, without a default port.
/// "null" is rejected, because any page can have it.
bool is_origin(std::string_view text) {
  const auto colon = text.find("://");
  if (colon == 0 || colon == std::string_view::npos) return false;
  const std::string_view scheme = text.substr(0, colon), rest = text.substr(colon + 3);
  const auto end = rest.starts_with('[') ? rest.find(']') + 1 : std::min(rest.find(':'), rest.size());
  const std::string_view host = rest.substr(0, end), port = rest.substr(end);
  const bool is_name = !host.empty() && are(host, "-.");
  const bool is_ipv6 = host.size() > 2 && is_address(std::string(host.substr(1, host.size() - 2)));
  const bool is_default = (scheme == "http" && port == ":80") || (scheme == "https" && port == ":443");
  return are(scheme, "+-.") && (host.starts_with('[') ? is_ipv6 : is_name) && !is_default &&
         (port.empty() || (port.size() > 1 && port.starts_with(':') && is_port(port.substr(1))));
}

bool are_origins(const std::string& text) {
  constexpr std::size_t kLongest = 1000;
  return text.size() <= kLongest && std::ranges::all_of(words(text), is_origin);
}

/// "off", "duplicates" or "all"
std::string range_of(std::span<const std::string_view> words) {
  std::string text;
  for (const std::string_view& word : words) {
    if (!text.empty()) text.append(&word == &words.back() ? " or " : ", ");
    text.append("\"").append(word).append("\"");
  }
  return text;
}

std::string digits(double number) {
  char text[400];  // the longest double in fixed notation has 309 digits before its point
  return {text, std::to_chars(text, text + sizeof text, number, std::chars_format::fixed).ptr};
}

/// The value for Kind::put(). std::nullopt: `value` is out of range.
std::optional<codec::Value> meant(const Kind& kind, const codec::Value& value) {
  const auto* const text = std::get_if<std::string>(&value.is);
  codec::Reading reading;
  const codec::Field field(value, reading);
  switch (kind.of) {
    case Kind::Of::Flag:
      return std::holds_alternative<bool>(value.is) ? std::optional(value) : std::nullopt;
    case Kind::Of::Version:
    case Kind::Of::Whole: {
      const auto number =
          field.whole(static_cast<std::int64_t>(kind.least), static_cast<std::int64_t>(kind.most));
      if (reading.refused()) return std::nullopt;
      return codec::Value{static_cast<std::uint64_t>(number)};
    }
    case Kind::Of::Real: {
      const double number = field.number(kind.least, kind.most);
      return reading.refused() ? std::nullopt : std::optional(codec::Value{number});
    }
    case Kind::Of::Text:
      return text != nullptr && kind.form->fits(*text) ? std::optional(value) : std::nullopt;
    case Kind::Of::Choice:
      break;
  }
  const auto found = text == nullptr ? kind.words.end() : std::ranges::find(kind.words, *text);
  if (found == kind.words.end()) return std::nullopt;
  return codec::Value{static_cast<std::uint64_t>(found - kind.words.begin())};
}

}  // namespace

constexpr Form kAddress{is_address, "an IPv4 or IPv6 address"};
/// The kernel's dev_valid_name().
constexpr Form kInterface{
    [](const std::string& text) { return is_name(text, 15, "/:") && text != "." && text != ".."; },
    "an interface's name of at most 15 characters, or \"\""};
constexpr Form kChip{[](const std::string& text) { return is_name(text, 64); },
                     "a GPIO chip's name or path, or \"\""};
/// GPIO_MAX_NAME_SIZE of linux/gpio.h, without the NUL.
constexpr Form kLine{[](const std::string& text) { return is_name(text, 31); },
                     "a GPIO line's name of at most 31 characters, or \"\""};
constexpr Form kRobot{[](const std::string& text) { return icd::RobotName::parse(text).has_value(); },
                      "1 to 10 letters, digits and underscores"};
constexpr Form kAlias{kChip.fits, "at most 64 visible ASCII characters, or \"\""};
constexpr Form kCourse{is_course, "1 to 20 letters, digits, underscores and hyphens"};
constexpr Form kCourseOrNone{[](const std::string& text) { return text.empty() || is_course(text); },
                             "a course's name, or \"\""};
constexpr Form kIpv4OrNone{[](const std::string& text) { return text.empty() || ipv4_of(text).has_value(); },
                           "an IPv4 address, or \"\""};
constexpr Form kOrigins{
    are_origins, "origins as browsers write them (http://10.0.0.20:3000) with spaces between them, or \"\""};

std::expected<void, std::string> put(const Kind& kind, const codec::Value& value, Settings& settings) {
  if (const auto member = meant(kind, value)) {
    kind.put(settings, *member);
    return {};
  }
  const std::string_view before = kind.of == Kind::Of::Whole  ? "a whole number from "
                                  : kind.of == Kind::Of::Real ? "a number from "
                                                              : "";
  return std::unexpected(icd::sentence("expected ", before, range_of(kind), ", got ", shown(value)));
}

std::string range_of(const Kind& kind) {
  switch (kind.of) {
    case Kind::Of::Flag:
      return "true or false";
    case Kind::Of::Whole:
    case Kind::Of::Real:
      return digits(kind.least) + " to " + digits(kind.most);
    case Kind::Of::Text:
      return std::string(kind.form->range);
    case Kind::Of::Choice:
      return range_of(kind.words);
    case Kind::Of::Version:
      break;
  }
  return "1";
}

codec::Value value_of(const Kind& kind, const Settings& settings) {
  codec::Value value = kind.get(settings);
  if (kind.of != Kind::Of::Choice) return value;
  return {std::string(kind.words[std::get<std::uint64_t>(value.is)])};
}

codec::Value bound_of(const Kind& kind, double bound) {
  return kind.of == Kind::Of::Whole ? codec::Value{static_cast<std::uint64_t>(bound)} : codec::Value{bound};
}

std::string_view name_of(const Kind& kind) {
  static constexpr std::string_view kNames[] = {"flag", "whole", "real", "text", "choice", "version"};
  return kNames[static_cast<std::size_t>(kind.of)];
}

bool is_word(std::string_view text, std::size_t longest) {
  return !text.empty() && text.size() <= longest && std::ranges::all_of(text, [](char letter) {
    return icd::is_letter_or_digit(letter) || letter == '_' || letter == '-';
  });
}

std::string shown(const codec::Value& value) {
  static constexpr std::size_t kLongest = 48;
  if (std::holds_alternative<codec::Value::Array>(value.is) ||
      std::holds_alternative<codec::Value::Object>(value.is)) {
    return value.kind();
  }
  std::string text = codec::write_json(value);
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  return text;
}

namespace {

// A function that names a member of Settings, const or not.
// NOLINTNEXTLINE(bugprone-macro-parentheses): parentheses would make it no member
#define MEMBER(path) [](auto& s) -> auto& { return s.path; }

constexpr bool kRequired = true;
constexpr std::uint64_t kMiB = 1u << 20;
constexpr std::string_view kReviews[] = {"off", "duplicates", "all"};  // as dispatch::Review

constexpr Key kKeys[] = {
    {"version", "The layout of this file.", Kind(), kRequired},

    {"command_post.scoring.address", "The scoring endpoint, as posted in the Base Station area (ICD 3).",
     text<MEMBER(command_post.scoring.address)>(kAddress), kRequired},
    {"command_post.scoring.port", "Its port.", whole<MEMBER(command_post.scoring.port)>(1, 65535), kRequired},
    {"command_post.mapping.address", "The mapping endpoint.",
     text<MEMBER(command_post.mapping.address)>(kAddress), kRequired},
    {"command_post.mapping.port", "Its port.", whole<MEMBER(command_post.mapping.port)>(1, 65535), kRequired},
    {"command_post.interface",
     "The only interface to the Command Post (darpa0); empty: the routes select one.",
     text<MEMBER(command_post.interface)>(kInterface)},
    {"command_post.budget_mbit", "Megabits a second for both endpoints together, at most (ICD 3).",
     real<MEMBER(command_post.budget_mbit)>(0.1, 100000)},
    {"command_post.rates.reports_hz", "Artifact reports sent a second, at most (ICD 4.1).",
     real<MEMBER(command_post.rates.reports_hz)>(0.001, 1000)},
    {"command_post.rates.status_hz", "Requests for the run's status a second, at most.",
     real<MEMBER(command_post.rates.status_hz)>(0.001, 1000)},
    {"command_post.rates.map_hz", "Maps sent a second, at most.",
     real<MEMBER(command_post.rates.map_hz)>(0.001, 1000)},
    {"command_post.rates.state_hz", "State updates sent a second, at most; each holds all robots.",
     real<MEMBER(command_post.rates.state_hz)>(0.001, 1000)},
    {"command_post.rates.markers_hz", "Markers updates sent a second, at most.",
     real<MEMBER(command_post.rates.markers_hz)>(0.001, 1000)},
    {"command_post.timeouts.connect_ms", "How long connecting may take.",
     whole<MEMBER(command_post.timeouts.connect)>(100, 60000)},
    {"command_post.timeouts.scoring_answer_ms",
     "How long the scoring endpoint may be silent. Then a report is in doubt.",
     whole<MEMBER(command_post.timeouts.scoring_answer)>(100, 600000)},
    {"command_post.timeouts.mapping_answer_ms",
     "How long the mapping endpoint may be silent. Then Adit retries.",
     whole<MEMBER(command_post.timeouts.mapping_answer)>(100, 600000)},
    {"command_post.arrange_clouds",
     "Whether Adit removes padding and sorts points, to make clouds smaller. Points keep their values.",
     flag<MEMBER(command_post.arrange_clouds)>()},
    {"command_post.course", "The course in use, one of courses[].name; empty: the endpoints above.",
     text<MEMBER(command_post.course)>(kCourseOrNone)},

    {"courses[].name", "The course's name, for command_post.course.",
     text<MEMBER(courses.back().name)>(kCourse), kRequired},
    {"courses[].scoring.address", "Its scoring endpoint.",
     text<MEMBER(courses.back().scoring.address)>(kAddress), kRequired},
    {"courses[].scoring.port", "Its port.", whole<MEMBER(courses.back().scoring.port)>(1, 65535), kRequired},
    {"courses[].mapping.address", "Its mapping endpoint.",
     text<MEMBER(courses.back().mapping.address)>(kAddress), kRequired},
    {"courses[].mapping.port", "Its port.", whole<MEMBER(courses.back().mapping.port)>(1, 65535), kRequired},

    {"team.listen[].address",
     "An address at which clients reach Adit; 0.0.0.0: every address of team.interface.",
     text<MEMBER(team.listen.back().address)>(kAddress), kRequired},
    {"team.listen[].port", "Its port; 0: any free port.", whole<MEMBER(team.listen.back().port)>(0, 65535),
     kRequired},
    {"team.interface", "The only interface to the team (team0); empty: any interface.",
     text<MEMBER(team.interface)>(kInterface)},
    {"team.require_token",
     "Whether clients need the team's token or one of the Command Post's. If not, Adit serves all clients of "
     "the team's network, but web pages only of the box and of team.origins.",
     flag<MEMBER(team.require_token)>()},
    {"team.origins",
     "Origins whose web pages may post, reports included, and read the run's status without a token if "
     "team.require_token is off, in every browser of the team's network. With a token, pages of any origin "
     "may.",
     text<MEMBER(team.origins)>(kOrigins)},
    {"team.connections",
     "Connections of the team at once, at most. Unauthenticated clients get a quarter of them, at most 32.",
     whole<MEMBER(team.connections)>(1, 1024)},
    {"team.connections_per_address",
     "Connections from one address at once, at most, if authenticated or without team.require_token.",
     whole<MEMBER(team.connections_per_address)>(1, 1024)},

    {"robots[].name",
     "The registered name (ICD 2). If any robot is listed, the page reports others; Adit still accepts their "
     "messages.",
     text<MEMBER(robots.back().name)>(kRobot), kRequired},
    {"robots[].alias",
     "The name that this robot uses. Adit forwards its maps and states under robots[].name.",
     text<MEMBER(robots.back().alias)>(kAlias)},
    {"robots[].clouds",
     "How this robot posts clouds. auto: a newer cloud replaces a queued cloud whose points it contains. "
     "whole: each cloud contains the earlier ones and replaces them. parts: every cloud is sent.",
     choice<MEMBER(robots.back().clouds)>(queues::kCloudsWords)},
    {"robots[].precision",
     "How far Adit may round coordinates of this robot's clouds. exact: not at all. 1mm, 8mm: to such steps. "
     "auto: as far as the queued clouds require. Needs command_post.arrange_clouds.",
     choice<MEMBER(robots.back().precision)>(queues::kPrecisionWords)},
    {"robots[].colour",
     "The robot's colour on the pages and in the run's report. auto: by the order of the first poses. Robots "
     "of one colour have different lines.",
     choice<MEMBER(robots.back().colour)>(kColourWords)},

    {"network.confirm_within_ms",
     "How long you have to confirm new addresses of the box. Then it returns to the old ones.",
     whole<MEMBER(network.confirm_within)>(1000, 600000)},
    {"network.allow_overlap",
     "Whether the team's subnet may overlap the Command Post's. A robot cannot reach both subnets then.",
     flag<MEMBER(network.allow_overlap)>()},

    {"clock.ntp_server",
     "An NTP server on the team's network that sets the box's clock; empty: no server. Not on a PC.",
     text<MEMBER(clock.ntp_server)>(kIpv4OrNone)},
    {"clock.serve_ntp", "Whether the box, once its own clock is set, is the team's NTP server. Not on a PC.",
     flag<MEMBER(clock.serve_ntp)>()},

    {"reports.answer_within_ms",
     "How long a client waits for its report's answer. Then Adit answers 503 or 504 with the report's state.",
     whole<MEMBER(reports.answer_within)>(100, 600000)},
    {"reports.doubt_for_ms",
     "How late a Command Post may still record a report that it has read. Only after this time can the run's "
     "status show that a report in doubt was not recorded.",
     whole<MEMBER(reports.doubt_for)>(100, 600000)},
    {"reports.doubt_asks",
     "How many statuses in a row must show that a report was not recorded before Adit sends it again.",
     whole<MEMBER(reports.doubt_asks)>(1, 100)},
    {"reports.review",
     "Reports that are held until the operator sends them. off: no report. duplicates: near duplicates. all: "
     "every report.",
     choice<MEMBER(reports.review)>(kReviews)},
    {"reports.near_metres", "Two reports of one run and type are near duplicates within this distance.",
     real<MEMBER(reports.near_metres)>(0, 1000)},
    {"reports.undo_s",
     "How many seconds a report that the operator posts on the page waits before it is sent, so that the "
     "operator can undo it. 0: it is sent at once.",
     whole<MEMBER(reports.undo)>(0, 60)},

    {"queues.map_bytes", "Bytes of queued maps, at most. Beyond that, Adit rejects a map with 429.",
     whole<MEMBER(queues.map_bytes)>(kMiB, 16384 * kMiB)},
    {"queues.merge_bytes", "Bytes of points in one merged cloud, at most; 0: clouds are never merged.",
     whole<MEMBER(queues.merge_bytes)>(0, 256 * kMiB)},
    {"queues.marker_bytes",
     "Bytes of queued markers, at most; three quarters for new ones. Beyond that, Adit rejects markers with "
     "429.",
     whole<MEMBER(queues.marker_bytes)>(kMiB, 1024 * kMiB)},
    {"queues.markers_per_message", "Markers in one update, at most.",
     whole<MEMBER(queues.markers_per_message)>(1, 100000)},
    {"queues.marker_bytes_per_message",
     "Bytes of markers in one update, at most, unless a single marker is larger.",
     whole<MEMBER(queues.marker_bytes_per_message)>(1024, 256 * kMiB)},

    {"runs.length_seconds", "How long a run lasts, for the countdown.",
     whole<MEMBER(runs.length_seconds)>(60, 86400)},
    {"runs.run_bytes",
     "Bytes of one run's map, tracks and plots, at most. Beyond that, Adit deletes its earliest pictures.",
     whole<MEMBER(runs.run_bytes)>(2 * kMiB, 1024 * kMiB)},
    {"runs.all_bytes",
     "Bytes of all runs' maps, tracks and plots, at most, and at most half of the disk's room. Beyond that, "
     "Adit deletes the oldest earlier run, but no report.",
     whole<MEMBER(runs.all_bytes)>(4 * kMiB, 65536 * kMiB)},

    {"alarms.silent_for_ms", "The shortest time without a message after which a robot is silent.",
     whole<MEMBER(alarms.silent_for)>(1000, 3600000)},
    {"alarms.silent_times", "How many of its usual intervals must also pass before a robot is silent.",
     real<MEMBER(alarms.silent_times)>(1, 1000)},

    {"rules.rewrite_frame_id",
     "Accept any frame_id and send \"darpa\". If not, Adit rejects other frames with 422.",
     flag<MEMBER(rules.rewrite_frame_id)>()},
    {"rules.forward_unknown_types",
     "Send artifact types other than the ICD's ten. If not, Adit rejects them with 422.",
     flag<MEMBER(rules.forward_unknown_types)>()},
    {"rules.map_bytes",
     "Bytes of one map's inflated data, at most. Beyond that, Adit rejects the map with 413.",
     whole<MEMBER(rules.map_bytes)>(1024, icd::kMostMapBytes)},

    {"panel.chip", "The GPIO chip (gpiochip0), by name, label or path; empty: any chip with the line.",
     text<MEMBER(panel.chip)>(kChip)},
    {"panel.health",
     "The line of the health light; empty: no light. Without any line, the panel is simulated.",
     text<MEMBER(panel.health)>(kLine)},
    {"panel.scoring", "The line of the scoring light.", text<MEMBER(panel.scoring)>(kLine)},
    {"panel.mapping", "The line of the mapping light.", text<MEMBER(panel.mapping)>(kLine)},
    {"panel.attention", "The line of the attention light.", text<MEMBER(panel.attention)>(kLine)},
    {"panel.active_low", "Whether lights are lit by a low line.", flag<MEMBER(panel.active_low)>()},
    {"panel.button", "The line of the button; empty: no button.", text<MEMBER(panel.button)>(kLine)},
    {"panel.button_active_low", "Whether the pressed button pulls its line low.",
     flag<MEMBER(panel.button_active_low)>()},
};

#undef MEMBER

template <auto member>
constexpr List list(std::string_view path, std::size_t least, std::size_t most) {
  return {path, least, most, [](const Settings& s) { return member(s).size(); },
          [](Settings& s, std::size_t size) { member(s).resize(size); }};
}

const List kLists[] = {
    list<[](auto& s) -> auto& { return s.courses; }>("courses", 0, 16),
    list<[](auto& s) -> auto& { return s.team.listen; }>("team.listen", 1, 16),
    list<[](auto& s) -> auto& { return s.robots; }>("robots", 0, 32),
};

}  // namespace

std::span<const Key> keys() {
  return kKeys;
}

const List& list_at(std::string_view path) {
  const List* const found = std::ranges::find(kLists, path, &List::path);
  icd::require(found != std::end(kLists));
  return *found;
}

Settings with_an_item_of_each() {
  Settings settings;
  for (const List& list : kLists) list.resize(settings, 1);
  return settings;
}

std::vector<Child> children_of(std::string_view prefix) {
  std::vector<Child> children;
  for (const Key& key : keys()) {
    if (!key.path.starts_with(prefix)) continue;
    const std::string_view rest = key.path.substr(prefix.size());
    const std::string_view name = rest.substr(0, rest.find_first_of(".["));
    if (!children.empty() && children.back().name == name) continue;
    children.push_back(
        {name, rest == name ? &key : nullptr, rest.size() > name.size() && rest[name.size()] == '['});
  }
  return children;
}

}  // namespace adit::settings
