#include "settings/reader.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>
#include <vector>

#include "codec/json.hpp"
#include "icd/sentence.hpp"
#include "icd/suggestion.hpp"
#include "icd/text.hpp"
#include "settings/keys.hpp"
#include "settings/subnet.hpp"

namespace adit::settings {
namespace {

using codec::Member;
using codec::Row;
using codec::Value;

/// A member's name in a path: as it is if a plain word, else as a JSON string.
std::string shown_name(const std::string& name) {
  return is_word(name, 48) ? name : value_text(Value{name});
}

std::string digits(double number) {
  char text[400];  // the longest double in fixed notation has 309 digits before its point
  return {text, std::to_chars(text, text + sizeof text, number, std::chars_format::fixed).ptr};
}

/// "team.listen"
std::string join_path(const std::string& path, std::string_view name) {
  return path.empty() ? std::string(name) : path + "." + std::string(name);
}

}  // namespace

std::expected<Value, std::vector<Error>> read_json(std::string_view json) {
  auto root = codec::parse_json(json);
  if (!root) return std::unexpected(std::vector<Error>{{"", root.error()}});
  return *std::move(root);
}

void Reader::read_object(const Value& value, const Row& row, void* into, const std::string& path) {
  const auto* members = std::get_if<Value::Object>(&value.is);
  if (members == nullptr) {
    errors.push_back({path, "expected an object, got " + value_text(value)});
    return;
  }
  std::vector<std::string_view> seen;
  for (const auto& [name, given] : *members) {
    const auto member = std::ranges::find(row.members, name, &Member::name);
    if (&row == &Robot::kRow && name == "voxel_metres") {  // of earlier versions; 0 was the default
      if (value_text(given) != "0") without_effect.push_back(join_path(path, name));
    } else if (member == row.members.end()) {
      report_unknown(name, row, path);
    } else if (std::ranges::find(seen, name) != seen.end()) {
      errors.push_back({join_path(path, name), "given twice"});
    } else {
      seen.push_back(member->name);
      read_member(given, *member, into, join_path(path, name));
    }
  }
  for (const Member& member : row.members) {
    if (std::ranges::find(seen, member.name) == seen.end())
      report_missing(member, into, join_path(path, member.name));
  }
}

void Reader::read_member(const Value& value, const Member& member, void* into, const std::string& path) {
  const codec::Schema& schema = *member.kind->schema;
  void* const at = member.in(into);
  if (schema.items != nullptr) return read_list(value, member, at, path);
  if (schema.row != nullptr)
    return read_object(value, *schema.row, member.kind->add == nullptr ? at : member.kind->add(at), path);
  codec::Reading reading;
  const codec::Field field(value, reading);
  codec::read_member(member, field, into);
  const bool is_flag = schema.type == "boolean", is_number = schema.type == "number";
  if (!reading.has_refusal() && (!is_flag || field.is<bool>())) return;  // 0 and 1 are no flags here
  const std::string_view before = is_number                    ? "a number from "
                                  : member.least < member.most ? "a whole number from "
                                                               : "";
  errors.push_back({path, icd::sentence("expected ", before, range_of(member), ", got ", value_text(value))});
}

void Reader::read_list(const Value& value, const Member& member, void* list, const std::string& path) {
  const auto* items = std::get_if<Value::Array>(&value.is);
  const double size = items == nullptr ? -1 : static_cast<double>(items->size());
  if (!(*member.least <= size && size <= *member.most)) {
    const std::string got = items == nullptr ? value_text(value) : std::to_string(items->size());
    errors.push_back({path, icd::sentence("expected ", range_of(member), ", got ", got)});
    return;
  }
  for (std::size_t i = 0; i < items->size(); ++i) {
    read_object((*items)[i], *row_of(*member.kind->schema), member.kind->add(list),
                icd::sentence(path, "[", i, "]"));
  }
}

void Reader::report_unknown(const std::string& name, const Row& row, const std::string& path) {
  if (passes_unknown) return passed_over.push_back(join_path(path, shown_name(name)));
  std::vector<std::string_view> known;
  known.reserve(row.members.size());
  for (const Member& member : row.members) known.push_back(member.name);
  errors.push_back(
      {join_path(path, shown_name(name)), icd::sentence("no such key", icd::did_you_mean(name, known),
                                                        " (keys here: ", icd::join_words(known), ")")});
}

/// Names each required key at once, so that the user can write all of them.
void Reader::report_missing(const Member& member, void* into, const std::string& path) {
  if (!member.is_needed) return;
  if (member.kind->schema->row != nullptr) {
    read_object(Value{Value::Object{}}, *member.kind->schema->row, member.in(into), path);
  } else {
    errors.push_back({path, "missing; expected " + range_of(member)});
  }
}

std::string range_of(const Member& member) {
  const codec::Schema& schema = *member.kind->schema;
  if (member.form != nullptr) return std::string(member.form->range);
  if (schema.type == "boolean") return "true or false";
  if (!member.words.empty()) return codec::list_alternatives(member.words, "\"");
  const std::string least = digits(*member.least), most = digits(*member.most);
  if (schema.items == nullptr) return least == most ? least : icd::sentence(least, " to ", most);
  return *member.least == 0 ? icd::sentence("a list of at most ", most, " items")
                            : icd::sentence("a list of ", least, " to ", most, " items");
}

namespace {

std::string item(std::size_t index) {
  return "team.listen[" + std::to_string(index) + "]";
}

/// Properties of an IPv4 or IPv6 address.
struct Host {
  bool any = false, loopback = false;
  bool several = false;  // multicast or broadcast
  bool mapped = false;   // IPv4 within IPv6
};

Host host_of(const std::string& text) {
  if (const auto ipv4 = ipv4_of(text)) {
    return {.any = *ipv4 == 0, .loopback = *ipv4 >> 24 == 127, .several = *ipv4 >> 28 >= 14};
  }
  in6_addr ipv6{};
  if (inet_pton(AF_INET6, text.c_str(), &ipv6) != 1) return {};
  return {.any = IN6_IS_ADDR_UNSPECIFIED(&ipv6) != 0,
          .loopback = IN6_IS_ADDR_LOOPBACK(&ipv6) != 0,
          .several = IN6_IS_ADDR_MULTICAST(&ipv6) != 0,
          .mapped = IN6_IS_ADDR_V4MAPPED(&ipv6) != 0};
}

/// Whether `listen` receives traffic to `endpoint`, as far as the addresses show.
bool can_receive(const Address& listen, const Address& endpoint) {
  if (listen == endpoint) return true;
  return listen.port == endpoint.port && host_of(listen.address).any && host_of(endpoint.address).loopback;
}

bool is_endpoint(const Address& listen, const Settings& settings) {
  const auto has = [&](const auto& post) {
    return can_receive(listen, post.scoring) || can_receive(listen, post.mapping);
  };
  return has(settings.command_post) || std::ranges::any_of(settings.courses, has);
}

void check_endpoint(const std::string& path, const Address& address, std::vector<Error>& errors) {
  const Host host = host_of(address.address);
  if (host.any || host.several) {
    errors.push_back({path, icd::sentence(address.address, " is no address of one machine")});
  } else if (host.mapped) {
    errors.push_back(
        {path, icd::sentence(address.address, " is an IPv4 address: write it in the form 10.0.0.1")});
  }
}

void check_ntp_server(const std::string& address, std::vector<Error>& errors) {
  const Host host = host_of(address);
  if (!address.empty() && (host.any || host.several || host.loopback))
    errors.push_back({"clock.ntp_server", icd::sentence(address, " is no address of another machine")});
}

void check_endpoints(const Settings& settings, std::vector<Error>& errors) {
  const auto is_own = [&settings](const Address& endpoint) {  // check_listen() reports these
    return std::ranges::find(settings.team.listen, endpoint) != settings.team.listen.end();
  };
  const auto check = [&](const std::string& of, const auto& post) {
    if (!is_own(post.scoring)) check_endpoint(of + ".scoring.address", post.scoring, errors);
    if (!is_own(post.mapping)) check_endpoint(of + ".mapping.address", post.mapping, errors);
  };
  check("command_post", settings.command_post);
  for (std::size_t i = 0; i < settings.courses.size(); ++i) {
    check(icd::sentence("courses[", i, "]"), settings.courses[i]);
  }
}

void check_listen(const Settings& settings, std::vector<Error>& errors) {
  const auto& listen = settings.team.listen;
  for (std::size_t i = 0; i < listen.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (listen[i].port != 0 && listen[i] == listen[j])
        errors.push_back({item(i), "the same as " + item(j)});
    }
    if (is_endpoint(listen[i], settings)) {
      errors.push_back(
          {item(i), "the same as an endpoint of the Command Post, so that Adit would post to itself"});
    }
  }
}

/// Names are unique. An alias is no other robot's alias and no robot's name, so that senders are unambiguous.
void check_robots(const std::vector<Robot>& robots, std::vector<Error>& errors) {
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const std::string name = icd::sentence("robots[", i, "].name"),
                      alias = icd::sentence("robots[", i, "].alias");
    for (std::size_t j = 0; j < robots.size(); ++j) {
      if (j < i && robots[i].name == robots[j].name) {
        errors.push_back({name, icd::sentence("the same as robots[", j, "].name")});
      }
      if (robots[i].alias.empty()) continue;
      if (j < i && robots[i].alias == robots[j].alias) {
        errors.push_back({alias, icd::sentence("the same as robots[", j, "].alias")});
      }
      if (robots[i].alias == robots[j].name) {
        errors.push_back(
            {alias, icd::sentence("the same as robots[", j, "].name; an alias is another name")});
      }
    }
  }
}

void check_courses(const Settings& settings, std::vector<Error>& errors) {
  const std::vector<Course>& courses = settings.courses;
  for (std::size_t i = 0; i < courses.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (courses[i].name == courses[j].name) {
        errors.push_back(
            {icd::sentence("courses[", i, "].name"), icd::sentence("the same as courses[", j, "].name")});
      }
    }
  }
  const std::string& course = settings.command_post.course;
  if (course.empty() || std::ranges::find(courses, course, &Course::name) != courses.end()) return;
  const std::string known = icd::join_words(courses, &Course::name);
  errors.push_back({"command_post.course",
                    icd::sentence("no course is called ", course,
                                  known.empty() ? "; no courses are set up" : "; the courses are ", known)});
}

}  // namespace

void check_panel(const Panel& panel, std::vector<Error>& errors) {
  const std::array<std::pair<const char*, const std::string&>, 5> lines = {
      {{"panel.health", panel.health},
       {"panel.scoring", panel.scoring},
       {"panel.mapping", panel.mapping},
       {"panel.attention", panel.attention},
       {"panel.button", panel.button}}};
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto& [path, line] = lines[i];
    for (std::size_t j = 0; j < i; ++j) {
      if (!line.empty() && line == lines[j].second) {
        errors.push_back({path, std::string("the same line as ") + lines[j].first});
      }
    }
  }
  if (!panel.chip.empty() && panel.is_simulated()) {
    errors.push_back({"panel.chip", "names a chip, but neither a light nor the button has a line"});
  }
}

std::vector<Error> contradictions(const Settings& settings) {
  std::vector<Error> errors;
  check_endpoints(settings, errors);
  check_ntp_server(settings.clock.ntp_server, errors);
  check_listen(settings, errors);
  check_panel(settings.panel, errors);
  check_robots(settings.robots, errors);
  check_courses(settings, errors);
  return errors;
}

}  // namespace adit::settings
