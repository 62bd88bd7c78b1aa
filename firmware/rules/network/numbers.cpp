#include "network/numbers.hpp"

#include <algorithm>
#include <utility>

#include "icd/sentence.hpp"
#include "icd/text.hpp"
#include "settings/keys.hpp"

namespace adit::network {
namespace {

using codec::Value;
using settings::Error;
using settings::Subnet;

using settings::value_text;

/// The members of one object, read by name. Collects the errors.
class Members {
 public:
  Members(const Value* value, std::string path, std::vector<Error>& errors)
      : path_(std::move(path)), errors_(errors) {
    if (value == nullptr) {
      errors_.push_back({path_, "missing"});
    } else if (object_ = std::get_if<Value::Object>(&value->is); object_ == nullptr) {
      errors_.push_back({path_, "expected an object, got " + value_text(*value)});
    }
  }

  bool are_there() const { return object_ != nullptr; }
  std::string path_of(std::string_view name) const {
    return path_.empty() ? std::string(name) : icd::sentence(path_, ".", name);
  }
  const Value* find(std::string_view name) {
    known_.emplace_back(name);
    return object_ == nullptr ? nullptr : codec::find_member(*object_, name);
  }
  void refuse(std::string_view name, std::string what) {
    errors_.push_back({path_of(name), std::move(what)});
  }

  std::optional<std::uint32_t> address(std::string_view name, bool may_be_none = false) {
    const Value* value = find(name);
    const auto* text = value == nullptr ? nullptr : std::get_if<std::string>(&value->is);
    if (may_be_none && is_none(value)) return std::nullopt;
    if (object_ == nullptr) return std::nullopt;  // reported already
    if (value == nullptr) {
      refuse(name, "missing");
      return std::nullopt;
    }
    const auto address = text == nullptr ? std::nullopt : settings::ipv4_of(*text);
    if (!address) refuse(name, "expected an IPv4 address such as 192.168.7.11, got " + value_text(*value));
    return address;
  }

  std::optional<std::uint8_t> prefix(std::string_view name) {
    const Value* value = find(name);
    if (object_ == nullptr) return std::nullopt;
    std::optional<std::uint64_t> number;
    if (value == nullptr) {
      refuse(name, "missing");
      return std::nullopt;
    }
    if (const auto* whole = std::get_if<std::int64_t>(&value->is); whole != nullptr && *whole >= 0) {
      number = static_cast<std::uint64_t>(*whole);
    } else if (const auto* natural = std::get_if<std::uint64_t>(&value->is)) {
      number = *natural;
    }
    if (!number || *number < kWidest || *number > kNarrowest) {
      refuse(name, icd::sentence("expected a whole number from ", kWidest, " to ", kNarrowest, ", got ",
                                 value_text(*value)));
      return std::nullopt;
    }
    return static_cast<std::uint8_t>(*number);
  }

  /// Static if absent.
  Mode mode() {
    const Value* value = find("mode");
    if (value == nullptr) return Mode::Static;
    const auto* text = std::get_if<std::string>(&value->is);
    for (const Mode each : {Mode::Static, Mode::Dhcp, Mode::LinkLocal}) {
      if (text != nullptr && *text == name_of(each)) return each;
    }
    refuse("mode", "expected " + codec::list_alternatives(kModeWords) + ", got " + value_text(*value));
    return Mode::Static;
  }

  /// Rejects a member that has no meaning in this mode.
  void none(std::string_view name, std::string_view why) {
    if (const Value* value = find(name); !is_none(value)) {
      refuse(name, icd::sentence("expected none ", why, ", got ", value_text(*value)));
    }
  }

  /// Rejects members that were not read. Call after all others.
  void finish() {
    if (object_ == nullptr) return;
    for (auto member = object_->begin(); member != object_->end(); ++member) {
      if (std::ranges::find(known_, member->first) == known_.end()) {
        refuse(icd::quote_text(member->first), "unknown member");
      } else if (std::ranges::find(object_->begin(), member, member->first, &Value::Member::first) !=
                 member) {
        refuse(member->first, "given twice");
      }
    }
  }

 private:
  static bool is_none(const Value* value) {
    if (value == nullptr || std::holds_alternative<std::nullptr_t>(value->is)) return true;
    const auto* text = std::get_if<std::string>(&value->is);
    return text != nullptr && text->empty();
  }

  std::string path_;
  std::vector<Error>& errors_;
  const Value::Object* object_ = nullptr;
  std::vector<std::string> known_;
};

constexpr std::uint32_t kLinkLocal = 169u << 8 | 254;  // the first two numbers of 169.254.0.0/16

/// Why a host of the subnet cannot have the address, or "".
std::string address_error(std::uint32_t address, const Subnet& subnet) {
  const std::uint32_t first = address >> 24;
  if (first == 0 || first == 127 || first >= 224) return "is not an address that a host can have";
  if (address >> 16 == kLinkLocal) return "is link-local: a host chooses such an address itself (RFC 3927)";
  if (address == subnet.first()) return "is the address of the subnet " + to_text(subnet) + " itself";
  if (address == subnet.last()) return "is the broadcast address of " + to_text(subnet);
  return "";
}

std::optional<Subnet> host(Members& members) {
  const auto address = members.address("address");
  const auto prefix = members.prefix("prefix");
  if (!address || !prefix) return std::nullopt;
  const Subnet subnet{*address, *prefix};
  if (const std::string why = address_error(*address, subnet); !why.empty()) {
    members.refuse("address", icd::sentence(settings::ipv4_text(*address), " ", why));
  }
  return subnet;
}

void read_team(Members& team, Numbers& numbers) {
  if (!team.are_there()) return;
  numbers.mode = team.mode();
  if (numbers.mode == Mode::Static) {
    numbers.team = host(team).value_or(Subnet{});
  } else {
    const std::string why = icd::sentence("with mode ", name_of(numbers.mode));
    team.none("address", why);
    team.none("prefix", why);
  }
  team.finish();
}

/// All addresses of a list; if one is wrong, no list.
std::optional<std::vector<Subnet>> hosts(const Value::Array& list, const std::string& path,
                                         std::vector<Error>& errors) {
  const std::size_t before = errors.size();
  if (list.size() > kMostAddresses) {
    errors.push_back({path, icd::sentence("expected at most ", kMostAddresses, ", got ", list.size())});
    return std::nullopt;
  }
  std::vector<Subnet> all;
  for (std::size_t i = 0; i < list.size(); ++i) {
    Members each(&list[i], icd::sentence(path, "[", i, "]"), errors);
    const auto read = each.are_there() ? host(each) : std::nullopt;
    each.finish();
    if (!read) continue;
    const auto same = std::ranges::find(all, read->address, &Subnet::address);
    if (same != all.end()) each.refuse("address", settings::ipv4_text(read->address) + " is given twice");
    all.push_back(*read);
  }
  return errors.size() == before ? std::optional(std::move(all)) : std::nullopt;
}

/// Reads `addresses`, or the older form `address` and `prefix`.
std::optional<std::vector<Subnet>> own_of(Members& post, std::vector<Error>& errors) {
  const Value* list = post.find("addresses");
  if (list == nullptr && post.find("address") != nullptr) {
    const auto one = host(post);
    return one ? std::optional(std::vector{*one}) : std::nullopt;
  }
  if (list == nullptr) {
    post.refuse("addresses", "missing");
    return std::nullopt;
  }
  const auto* array = std::get_if<Value::Array>(&list->is);
  if (array == nullptr) {
    post.refuse("addresses", "expected a list of addresses, got " + value_text(*list));
    return std::nullopt;
  }
  return hosts(*array, post.path_of("addresses"), errors);
}

void check_gateway(Members& post, const Numbers& numbers) {
  const std::string text = settings::ipv4_text(*numbers.gateway);
  const Subnet* subnet = on_link(numbers, *numbers.gateway);
  if (subnet == nullptr) {
    post.refuse("gateway", icd::sentence(text, " is in no subnet of its interface, which has ",
                                         command_post_text(numbers)));
  } else if (std::ranges::find(numbers.command_post, *numbers.gateway, &Subnet::address) !=
             numbers.command_post.end()) {
    post.refuse("gateway", icd::sentence(text, " is the box's own address"));
  } else if (const std::string why = address_error(*numbers.gateway, *subnet); !why.empty()) {
    post.refuse("gateway", icd::sentence(text, " ", why));
  }
}

void read_command_post(Members& post, Numbers& numbers, std::vector<Error>& errors) {
  if (!post.are_there()) return;
  const auto own = own_of(post, errors);
  numbers.gateway = post.address("gateway", true);
  if (own) {
    numbers.command_post = *own;
    if (numbers.gateway) check_gateway(post, numbers);
  }
  post.finish();
}

/// The kernel would confuse the two sides.
void check_sides_differ(const Numbers& numbers, std::vector<Error>& errors) {
  if (numbers.mode != Mode::Static || numbers.team.address == 0) return;
  if (std::ranges::find(numbers.command_post, numbers.team.address, &Subnet::address) !=
      numbers.command_post.end()) {
    errors.push_back({"team.address", icd::sentence(settings::ipv4_text(numbers.team.address),
                                                    " is the box's address on the Command Post's side")});
  }
}

}  // namespace

std::expected<Numbers, std::vector<Error>> read_numbers(const Value& value) {
  std::vector<Error> errors;
  Members root(&value, "", errors);
  Numbers numbers;
  if (root.are_there()) {
    Members team(root.find("team"), "team", errors);
    read_team(team, numbers);
    Members post(root.find("command_post"), "command_post", errors);
    read_command_post(post, numbers, errors);
    check_sides_differ(numbers, errors);
    root.finish();
  }
  if (!errors.empty()) return std::unexpected(std::move(errors));
  return numbers;
}

const Subnet* on_link(const Numbers& numbers, std::uint32_t address) {
  const auto found =
      std::ranges::find_if(numbers.command_post, [&](const Subnet& each) { return each.contains(address); });
  return found == numbers.command_post.end() ? nullptr : &*found;
}

std::optional<std::uint32_t> next_hop(const Numbers& numbers, std::uint32_t address) {
  return on_link(numbers, address) != nullptr ? address : numbers.gateway;
}

std::string host_text(const Subnet& host) {
  return settings::ipv4_text(host.address) + '/' + std::to_string(host.prefix);
}

std::string team_text(const Numbers& numbers) {
  return numbers.mode == Mode::Static ? host_text(numbers.team) : std::string(name_of(numbers.mode));
}

std::string command_post_text(const Numbers& numbers) {
  return numbers.command_post.empty() ? "none" : icd::join_words(numbers.command_post, host_text);
}

}  // namespace adit::network

namespace adit::codec {

void KindOf<network::Numbers>::read(const Field& field, network::Numbers& numbers) {
  if (field.is_absent()) return field.refuse_kind("an object");
  auto read = network::read_numbers(*field.value());
  if (!read) return field.refuse(read.error().front().sentence());
  numbers = *std::move(read);
}

}  // namespace adit::codec
