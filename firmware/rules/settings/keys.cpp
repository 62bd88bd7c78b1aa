#include "settings/keys.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <array>

#include "codec/json.hpp"
#include "icd/robot_name.hpp"
#include "icd/text.hpp"
#include "settings/reader.hpp"
#include "settings/settings.hpp"
#include "settings/subnet.hpp"

namespace adit::settings {
namespace {

using codec::Form;
using codec::member;
using codec::Member;
using codec::Row;
using codec::Value;

bool is_address(std::string_view text) {
  const std::string given(text);
  in6_addr parsed{};
  return inet_pton(AF_INET, given.c_str(), &parsed) == 1 || inet_pton(AF_INET6, given.c_str(), &parsed) == 1;
}

/// Course names are parts of file names.
bool is_course(std::string_view text) {
  return is_word(text, 20);
}

/// At most `most` visible ASCII characters, without those in `without`.
bool is_name(std::string_view text, std::size_t most, std::string_view without = "") {
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
  const bool is_ipv6 = host.size() > 2 && is_address(host.substr(1, host.size() - 2));
  const bool is_default = (scheme == "http" && port == ":80") || (scheme == "https" && port == ":443");
  return are(scheme, "+-.") && (host.starts_with('[') ? is_ipv6 : is_name) && !is_default &&
         (port.empty() || (port.size() > 1 && port.starts_with(':') && is_port(port.substr(1))));
}

bool are_origins(std::string_view text) {
  constexpr std::size_t kLongest = 1000;
  return text.size() <= kLongest && std::ranges::all_of(words(text), is_origin);
}

constexpr Form kAddress{is_address, "an IPv4 or IPv6 address"};
/// The kernel's dev_valid_name().
constexpr Form kInterface{
    [](std::string_view text) { return is_name(text, 15, "/:") && text != "." && text != ".."; },
    "an interface's name of at most 15 characters, or \"\""};
constexpr Form kGpioChip{[](std::string_view text) { return is_name(text, 64); },
                         "a GPIO chip's name or path, or \"\""};
/// GPIO_MAX_NAME_SIZE of linux/gpio.h, without the NUL.
constexpr Form kGpioLine{[](std::string_view text) { return is_name(text, 31); },
                         "a GPIO line's name of at most 31 characters, or \"\""};
constexpr Form kRobot{[](std::string_view text) { return icd::RobotName::parse(text).has_value(); },
                      "1 to 10 letters, digits and underscores"};
constexpr Form kAlias{kGpioChip.fits, "at most 64 visible ASCII characters, or \"\""};
constexpr Form kCourse{is_course, "1 to 20 letters, digits, underscores and hyphens"};
constexpr Form kCourseOrNone{[](std::string_view text) { return text.empty() || is_course(text); },
                             "a course's name, or \"\""};
constexpr Form kIpv4OrNone{[](std::string_view text) { return text.empty() || ipv4_of(text).has_value(); },
                           "an IPv4 address, or \"\""};
constexpr Form kOrigins{
    are_origins, "origins as browsers write them (http://10.0.0.20:3000) with spaces between them, or \"\""};

/// A key with a default.
template <auto... at>
constexpr Member key(std::string_view name, std::string_view meaning) {
  return member<at...>(name, meaning).optional();
}

/// A key that is one of these words, in order from 0.
template <auto at, const auto& kWords>
constexpr Member choice(std::string_view name, std::string_view meaning) {
  using Word = codec::KindOfWord<codec::TypeAt<at>, kWords>;
  return codec::member_of_kind<Word, at>(name, meaning).optional().one_of(kWords);
}

template <class Struct, const auto& kKeys, std::size_t left_out>
constexpr Row kRowOf = codec::complete<Struct, left_out>({"", kKeys});

/// A struct with these keys; `left_out`: members without a key.
template <auto at, const auto& kKeys, std::size_t left_out = 0>
constexpr Member object(std::string_view name) {
  return codec::member_of_kind<
      codec::KindOfRow<codec::TypeAt<at>, kRowOf<codec::TypeAt<at>, kKeys, left_out>>, at>(name);
}

constexpr std::array<Member, 2> endpoint(std::string_view meaning) {
  return {member<&Address::address>("address", meaning).matching(kAddress),
          member<&Address::port>("port", "Its port.").within(1, 65535)};
}

constexpr std::uint64_t kMiB = 1u << 20;
constexpr std::string_view kReviews[] = {"off", "duplicates", "all"};  // as dispatch::Review

/// The number of the file's layout, which has no member.
struct Version {
  static Value write(const Settings& /*of*/) { return {std::int64_t{1}}; }
  static void read(const codec::Field& field, Settings& /*of*/) { field.integer(1, 1); }
  static constexpr codec::Schema schema = {.type = "integer"};
};

constexpr auto kScoringKeys = endpoint("The scoring endpoint, as posted in the Base Station area (ICD 3).");
constexpr auto kMappingKeys = endpoint("The mapping endpoint.");

constexpr Member kRatesKeys[] = {
    key<&Rates::reports_hz>("reports_hz", "Artifact reports sent a second, at most (ICD 4.1).")
        .within(0.001, 1000),
    key<&Rates::status_hz>("status_hz", "Requests for the run's status a second, at most.")
        .within(0.001, 1000),
    key<&Rates::map_hz>("map_hz", "Maps sent a second, at most.").within(0.001, 1000),
    key<&Rates::state_hz>("state_hz", "State updates sent a second, at most; each holds all robots.")
        .within(0.001, 1000),
    key<&Rates::markers_hz>("markers_hz", "Markers updates sent a second, at most.").within(0.001, 1000),
};

constexpr Member kTimeoutsKeys[] = {
    key<&Timeouts::connect>("connect_ms", "How long connecting may take.").within(100, 60000),
    key<&Timeouts::scoring_answer>("scoring_answer_ms",
                                   "How long the scoring endpoint may be silent. Then a report is in doubt.")
        .within(100, 600000),
    key<&Timeouts::mapping_answer>("mapping_answer_ms",
                                   "How long the mapping endpoint may be silent. Then Adit retries.")
        .within(100, 600000),
};

constexpr Member kCommandPostKeys[] = {
    object<&CommandPost::scoring, kScoringKeys>("scoring"),
    object<&CommandPost::mapping, kMappingKeys>("mapping"),
    key<&CommandPost::interface>(
        "interface", "The only interface to the Command Post (darpa0); empty: the routes select one.")
        .matching(kInterface),
    key<&CommandPost::budget_mbit>("budget_mbit",
                                   "Megabits a second for both endpoints together, at most (ICD 3).")
        .within(0.1, 100000),
    object<&CommandPost::rates, kRatesKeys>("rates"),
    object<&CommandPost::timeouts, kTimeoutsKeys>("timeouts"),
    key<&CommandPost::arrange_clouds>(
        "arrange_clouds",
        "Whether Adit removes padding and sorts points, to make clouds smaller. Points keep their values."),
    key<&CommandPost::course>("course",
                              "The course in use, one of courses[].name; empty: the endpoints above.")
        .matching(kCourseOrNone),
};

constexpr auto kCourseScoringKeys = endpoint("Its scoring endpoint.");
constexpr auto kCourseMappingKeys = endpoint("Its mapping endpoint.");

constexpr Member kCourseKeys[] = {
    member<&Course::name>("name", "The course's name, for command_post.course.").matching(kCourse),
    object<&Course::scoring, kCourseScoringKeys>("scoring"),
    object<&Course::mapping, kCourseMappingKeys>("mapping"),
};

constexpr Member kListenKeys[] = {
    member<&Address::address>(
        "address", "An address at which clients reach Adit; 0.0.0.0: every address of team.interface.")
        .matching(kAddress),
    member<&Address::port>("port", "Its port; 0: any free port.").within(0, 65535),
};

constexpr Member kTeamKeys[] = {
    member<&Team::listen>("listen").within(1, 16),
    key<&Team::interface>("interface", "The only interface to the team (team0); empty: any interface.")
        .matching(kInterface),
    key<&Team::require_token>(
        "require_token",
        "Whether clients need the team's token or one of the Command Post's. If not, Adit serves all clients "
        "of the team's network, but web pages only of the box and of team.origins."),
    key<&Team::origins>("origins",
                        "Origins whose web pages may post, reports included, and read the run's status "
                        "without a token if team.require_token is off, in every browser of the team's "
                        "network. With a token, pages of any origin may.")
        .matching(kOrigins),
    key<&Team::connections>("connections",
                            "Connections of the team at once, at most. Unauthenticated clients get a quarter "
                            "of them, at most 32.")
        .within(1, 1024),
    key<&Team::connections_per_address>(
        "connections_per_address",
        "Connections from one address at once, at most, if authenticated or without team.require_token.")
        .within(1, 1024),
};

constexpr Member kRobotKeys[] = {
    member<&Robot::name>("name",
                         "The registered name (ICD 2). If any robot is listed, the page reports others; Adit "
                         "still accepts their messages.")
        .matching(kRobot),
    key<&Robot::alias>(
        "alias", "The name that this robot uses. Adit forwards its maps and states under robots[].name.")
        .matching(kAlias),
    choice<&Robot::clouds, queues::kCloudsWords>(
        "clouds",
        "How this robot posts clouds. auto: a newer cloud replaces a queued cloud whose points it contains. "
        "whole: each cloud contains the earlier ones and replaces them. parts: every cloud is sent."),
    choice<&Robot::precision, queues::kPrecisionWords>(
        "precision",
        "How far Adit may round coordinates of this robot's clouds. exact: not at all. 1mm, 8mm: to such "
        "steps. auto: as far as the queued clouds require. Needs command_post.arrange_clouds."),
    choice<&Robot::colour, kColourWords>(
        "colour",
        "The robot's colour on the pages and in the run's report. auto: by the order of the "
        "first poses. Robots of one colour have different lines."),
};

constexpr Member kNetworkKeys[] = {
    key<&Network::confirm_within>(
        "confirm_within_ms",
        "How long you have to confirm new addresses of the box. Then it returns to the old ones.")
        .within(1000, 600000),
    key<&Network::allow_overlap>(
        "allow_overlap",
        "Whether the team's subnet may overlap the Command Post's. A robot cannot reach both subnets then."),
};

constexpr Member kPageKeys[] = {
    key<&Page::https_only>("https_only",
                           "Whether browsers may use the page only by HTTPS, while the box offers it. "
                           "Scripts with a token and the "
                           "ICD's URIs still work by HTTP."),
};

constexpr Member kClockKeys[] = {
    key<&Clock::ntp_server>(
        "ntp_server",
        "An NTP server on the team's network that sets the box's clock; empty: no server. Not on a PC.")
        .matching(kIpv4OrNone),
    key<&Clock::serve_ntp>(
        "serve_ntp", "Whether the box, once its own clock is set, is the team's NTP server. Not on a PC."),
};

constexpr Member kReportsKeys[] = {
    key<&Reports::answer_within>("answer_within_ms",
                                 "How long a client waits for its report's answer. Then Adit answers 503 or "
                                 "504 with the report's state.")
        .within(100, 600000),
    key<&Reports::doubt_for>("doubt_for_ms",
                             "How long Adit waits after a lost answer before the run's status can show that "
                             "the report was not recorded.")
        .within(100, 600000),
    key<&Reports::doubt_asks>(
        "doubt_asks",
        "How many statuses in a row must show that a report was not recorded before Adit sends it again.")
        .within(1, 100),
    choice<&Reports::review, kReviews>(
        "review",
        "Reports that are held until the operator sends them. off: no report. duplicates: "
        "near duplicates. all: every report."),
    key<&Reports::near_metres>("near_metres",
                               "Two reports of one run and type are near duplicates within this distance.")
        .within(0, 1000),
    key<&Reports::undo>("undo_s",
                        "How many seconds a report that the operator posts on the page waits before it is "
                        "sent, so that the operator can undo it. 0: it is sent at once.")
        .within(0, 60),
};

constexpr Member kQueuesKeys[] = {
    key<&Queues::map_bytes>("map_bytes",
                            "Bytes of queued maps, at most. Beyond that, Adit rejects a map with 429.")
        .within(kMiB, 16384 * kMiB),
    key<&Queues::merge_bytes>("merge_bytes",
                              "Bytes of points in one merged cloud, at most; 0: clouds are never merged.")
        .within(0, 256 * kMiB),
    key<&Queues::marker_bytes>("marker_bytes",
                               "Bytes of queued markers, at most; three quarters for new ones. Beyond that, "
                               "Adit rejects markers with 429.")
        .within(kMiB, 1024 * kMiB),
    key<&Queues::markers_per_message>("markers_per_message", "Markers in one update, at most.")
        .within(1, 100000),
    key<&Queues::marker_bytes_per_message>(
        "marker_bytes_per_message",
        "Bytes of markers in one update, at most, unless a single marker is larger.")
        .within(1024, 256 * kMiB),
};

constexpr Member kRunsKeys[] = {
    key<&Runs::length_seconds>("length_seconds", "How long a run lasts, for the countdown.")
        .within(60, 86400),
    key<&Runs::run_bytes>(
        "run_bytes",
        "Bytes of one run's map, tracks and plots, at most. Beyond that, Adit deletes its earliest pictures.")
        .within(2 * kMiB, 1024 * kMiB),
    key<&Runs::all_bytes>("all_bytes",
                          "Bytes of all runs' maps, tracks and plots, at most, and at most half of the "
                          "disk's room. Beyond that, Adit deletes the oldest earlier run, but no report.")
        .within(4 * kMiB, 65536 * kMiB),
};

constexpr Member kAlarmsKeys[] = {
    key<&Alarms::silent_for>("silent_for_ms",
                             "The shortest time without a message after which a robot is silent.")
        .within(1000, 3600000),
    key<&Alarms::silent_times>("silent_times",
                               "A robot is silent after this many times its usual interval between messages, "
                               "and after silent_for_ms.")
        .within(1, 1000),
};

constexpr Member kRulesKeys[] = {
    key<&icd::Rules::rewrite_frame_id>(
        "rewrite_frame_id",
        "Accept any frame_id and send \"darpa\". If not, Adit rejects other frames with 422."),
    key<&icd::Rules::forward_unknown_types>(
        "forward_unknown_types",
        "Send artifact types other than the ICD's ten. If not, Adit rejects them with 422."),
    key<&icd::Rules::map_bytes>(
        "map_bytes", "Bytes of one map's inflated data, at most. Beyond that, Adit rejects the map with 413.")
        .within(1024, icd::kMostMapBytes),
};

constexpr Member kPanelKeys[] = {
    key<&Panel::chip>("chip",
                      "The GPIO chip (gpiochip0), by name, label or path; empty: any chip with the line.")
        .matching(kGpioChip),
    key<&Panel::health>(
        "health", "The line of the health light; empty: no light. Without any line, the panel is simulated.")
        .matching(kGpioLine),
    key<&Panel::scoring>("scoring", "The line of the scoring light.").matching(kGpioLine),
    key<&Panel::mapping>("mapping", "The line of the mapping light.").matching(kGpioLine),
    key<&Panel::attention>("attention", "The line of the attention light.").matching(kGpioLine),
    key<&Panel::active_low>("active_low", "Whether lights are lit by a low line."),
    key<&Panel::button>("button", "The line of the button; empty: no button.").matching(kGpioLine),
    key<&Panel::button_active_low>("button_active_low", "Whether the pressed button pulls its line low."),
};

constexpr Member kSettingsKeys[] = {
    codec::made_of<Settings, Version>("version", "The layout of this file.").within(1, 1),
    object<&Settings::command_post, kCommandPostKeys>("command_post"),
    key<&Settings::courses>("courses", "").within(0, 16),
    object<&Settings::team, kTeamKeys>("team"),
    key<&Settings::robots>("robots", "").within(0, 32),
    object<&Settings::network, kNetworkKeys>("network"),
    object<&Settings::page, kPageKeys>("page"),
    object<&Settings::clock, kClockKeys>("clock"),
    object<&Settings::reports, kReportsKeys>("reports"),
    object<&Settings::queues, kQueuesKeys>("queues"),
    object<&Settings::runs, kRunsKeys>("runs"),
    object<&Settings::alarms, kAlarmsKeys>("alarms"),
    object<&Settings::rules, kRulesKeys, 1>("rules"),  // without its aliases
    member<&Settings::panel>("panel"),
};

std::string_view kind_of(const Member& member) {
  const std::string_view type = member.kind->schema->type;
  if (!member.words.empty()) return "choice";
  if (type == "string") return "text";
  if (type == "boolean") return "flag";
  if (type == "number") return "real";
  return member.least < member.most ? "whole" : "version";
}

/// `in`: the row with its default.
Key key_of(const Member& member, void* in, std::string path) {
  Key key{.path = std::move(path),
          .meaning = std::string(member.meaning),
          .kind = std::string(kind_of(member)),
          .required = member.is_needed,
          .default_value = member.is_needed ? Value{} : member.kind->write(member.in(in)),
          .range = range_of(member)};
  if (!member.words.empty()) key.words.emplace(member.words.begin(), member.words.end());
  if (member.least < member.most) {
    const auto bound = [&key](double number) {
      return key.kind == "whole" ? Value{static_cast<std::int64_t>(number)} : Value{number};
    };
    key.least = bound(*member.least);
    key.most = bound(*member.most);
  }
  return key;
}

/// Adds an item to each list of `in`, for its defaults.
void add_keys(const Row& row, void* in, const std::string& prefix, std::vector<Key>& keys) {
  for (const Member& member : row.members) {
    std::string path = prefix + std::string(member.name);
    const codec::Schema& schema = *member.kind->schema;
    if (schema.items != nullptr) {
      add_keys(*schema.items->row, member.kind->add(member.in(in)), path + "[].", keys);
    } else if (schema.row != nullptr) {
      add_keys(*schema.row, member.in(in), path + ".", keys);
    } else {
      keys.push_back(key_of(member, in, std::move(path)));
    }
  }
}

}  // namespace

constexpr Row Course::kRow = codec::complete<Course>({"", kCourseKeys});
constexpr Row Address::kRow = codec::complete<Address>({"", kListenKeys});
constexpr Row Robot::kRow = codec::complete<Robot>({"", kRobotKeys});
constexpr Row Panel::kRow = codec::complete<Panel>({"", kPanelKeys});
constexpr Row Settings::kRow = codec::complete<Settings, 1>({"", kSettingsKeys});  // without without_effect

std::vector<Key> keys() {
  Settings defaults;
  std::vector<Key> all;
  add_keys(Settings::kRow, &defaults, "", all);
  return all;
}

bool is_word(std::string_view text, std::size_t longest) {
  return !text.empty() && text.size() <= longest && std::ranges::all_of(text, [](char letter) {
    return icd::is_letter_or_digit(letter) || letter == '_' || letter == '-';
  });
}

std::string value_text(const codec::Value& value) {
  static constexpr std::size_t kLongest = 48;
  if (std::holds_alternative<codec::Value::Array>(value.is) ||
      std::holds_alternative<codec::Value::Object>(value.is)) {
    return value.kind();
  }
  std::string text = codec::write_json(value);
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  return text;
}

}  // namespace adit::settings
