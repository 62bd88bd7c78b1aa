#include "network/numbers.hpp"

#include <algorithm>
#include <utility>

#include "codec/json.hpp"
#include "icd/sentence.hpp"

namespace adit::network {
namespace {

using codec::Value;
using settings::Error;
using settings::Subnet;

constexpr std::size_t kLongestShown = 48;

/// A value as a sentence shows it.
std::string shown(const Value& value) {
  if (std::holds_alternative<Value::Array>(value.is) || std::holds_alternative<Value::Object>(value.is)) {
    return value.kind();
  }
  std::string text = codec::write_json(value);
  if (text.size() > kLongestShown) text = text.substr(0, kLongestShown) + "...";
  return text;
}

/// The members of one object, each asked for by its name; what is wrong with them is gathered.
class Members {
 public:
  Members(const Value* value, std::string path, std::vector<Error>& errors)
      : path_(std::move(path)), errors_(errors) {
    if (value == nullptr) {
      errors_.push_back({path_, "missing"});
    } else if (object_ = std::get_if<Value::Object>(&value->is); object_ == nullptr) {
      errors_.push_back({path_, "expected an object, got " + shown(*value)});
    }
  }

  bool are_there() const { return object_ != nullptr; }
  std::string path_of(std::string_view name) const {
    return path_.empty() ? std::string(name) : icd::sentence(path_, ".", name);
  }
  const Value* find(std::string_view name) {
    known_.emplace_back(name);
    if (object_ == nullptr) return nullptr;
    const auto found = std::ranges::find(*object_, name, &Value::Member::first);
    return found == object_->end() ? nullptr : &found->second;
  }
  void refuse(std::string_view name, std::string what) {
    errors_.push_back({path_of(name), std::move(what)});
  }

  std::optional<std::uint32_t> address(std::string_view name, bool may_be_none = false) {
    const Value* value = find(name);
    const auto* text = value == nullptr ? nullptr : std::get_if<std::string>(&value->is);
    const bool is_none = value == nullptr || std::holds_alternative<std::nullptr_t>(value->is) ||
                         (text != nullptr && text->empty());
    if (is_none && may_be_none) return std::nullopt;
    if (object_ == nullptr) return std::nullopt;  // told already
    if (value == nullptr) {
      refuse(name, "missing");
      return std::nullopt;
    }
    const auto address = text == nullptr ? std::nullopt : settings::ipv4_of(*text);
    if (!address) refuse(name, "expected an IPv4 address such as 192.168.7.11, got " + shown(*value));
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
                                 shown(*value)));
      return std::nullopt;
    }
    return static_cast<std::uint8_t>(*number);
  }

  /// Once all that there may be has been asked for.
  void finish() {
    if (object_ == nullptr) return;
    for (auto member = object_->begin(); member != object_->end(); ++member) {
      if (std::ranges::find(known_, member->first) == known_.end()) {
        refuse(icd::in_quotes(member->first), "no such member here");
      } else if (std::ranges::find(object_->begin(), member, member->first, &Value::Member::first) !=
                 member) {
        refuse(member->first, "given twice");
      }
    }
  }

 private:
  std::string path_;
  std::vector<Error>& errors_;
  const Value::Object* object_ = nullptr;
  std::vector<std::string> known_;
};

/// Why no host of the subnet can have the address; "" where one can.
std::string unfit(std::uint32_t address, const Subnet& subnet) {
  const std::uint32_t first = address >> 24;
  if (first == 0 || first == 127 || first >= 224) return "is no address that a host can have";
  if (address == subnet.first()) return "is the address of the subnet " + written(subnet) + " itself";
  if (address == subnet.last()) return "is the broadcast address of " + written(subnet);
  return "";
}

std::optional<Subnet> host(Members& members) {
  const auto address = members.address("address");
  const auto prefix = members.prefix("prefix");
  if (!address || !prefix) return std::nullopt;
  const Subnet subnet{*address, *prefix};
  if (const std::string why = unfit(*address, subnet); !why.empty()) {
    members.refuse("address", icd::sentence(settings::ipv4_text(*address), " ", why));
  }
  return subnet;
}

void check_gateway(Members& members, std::uint32_t gateway, const Subnet& host) {
  const std::string text = settings::ipv4_text(gateway);
  if (!host.contains(gateway)) {
    members.refuse("gateway",
                   icd::sentence(text, " is not in ", written(host), ", the subnet of its interface"));
  } else if (gateway == host.address) {
    members.refuse("gateway", icd::sentence(text, " is the box's own address"));
  } else if (const std::string why = unfit(gateway, host); !why.empty()) {
    members.refuse("gateway", icd::sentence(text, " ", why));
  }
}

Value json(const Subnet& host) {
  return {Value::Object{{"address", {settings::ipv4_text(host.address)}},
                        {"prefix", {std::int64_t{host.prefix}}}}};
}

}  // namespace

std::expected<Numbers, std::vector<Error>> read_numbers(const Value& value) {
  std::vector<Error> errors;
  Members root(&value, "", errors);
  Numbers numbers;
  if (root.are_there()) {
    Members team(root.find("team"), "team", errors);
    numbers.team = host(team).value_or(Subnet{});
    team.finish();
    Members post(root.find("command_post"), "command_post", errors);
    const auto own = host(post);
    numbers.command_post = own.value_or(Subnet{});
    numbers.gateway = post.address("gateway", true);
    if (own && numbers.gateway) check_gateway(post, *numbers.gateway, *own);
    post.finish();
    root.finish();
  }
  if (!errors.empty()) return std::unexpected(std::move(errors));
  return numbers;
}

Value to_json(const Numbers& numbers) {
  Value post = json(numbers.command_post);
  std::get<Value::Object>(post.is).emplace_back(
      "gateway", Value{numbers.gateway ? settings::ipv4_text(*numbers.gateway) : std::string()});
  return {Value::Object{{"team", json(numbers.team)}, {"command_post", std::move(post)}}};
}

std::string host_text(const Subnet& host) {
  return settings::ipv4_text(host.address) + '/' + std::to_string(host.prefix);
}

}  // namespace adit::network
