#include "rehearsal/command_post/faults.hpp"

#include <algorithm>
#include <charconv>

namespace adit::rehearsal {
namespace {

constexpr const char* kTooMany = "no more than 10000 faults can wait";

std::optional<Aim> aim_named(std::string_view name) {
  const auto* const found = std::ranges::find(kAims, name);
  if (found == kAims.end()) return std::nullopt;
  return static_cast<Aim>(found - kAims.begin());
}

std::string no_such_aim(std::string_view name) {
  constexpr std::size_t longest = 80;
  return std::string("no such aim: '")
      .append(name.substr(0, longest))
      .append("'; there are reports, status, mapping");
}

}  // namespace

std::expected<Faults::Aimed, std::string> Faults::read_aimed(std::string_view text) {
  const auto colon = text.find(':');
  if (colon == std::string_view::npos) {
    return std::unexpected("expected an aim and a fault, as in reports:record-then-drop, got '" +
                           std::string(text) + "'");
  }
  const auto aim = aim_named(text.substr(0, colon));
  if (!aim) return std::unexpected(no_such_aim(text.substr(0, colon)));
  const auto fault = read_fault(text.substr(colon + 1));
  if (!fault) return std::unexpected(std::string(text.substr(0, colon)) + ": " + fault.error());
  return Aimed{*aim, *fault};
}

Faults::Told Faults::append(const std::vector<Aimed>& aimed) {
  const std::lock_guard lock(mutex_);
  std::size_t waiting = aimed.size();
  for (const auto& queue : queues_) waiting += queue.size();
  if (waiting > kMost) return std::unexpected(kTooMany);
  for (const auto& [aim, fault] : aimed) queue(aim).push_back(fault);
  return {};
}

Faults::Told Faults::tell(std::string_view aim_and_fault) {
  const auto aimed = read_aimed(aim_and_fault);
  if (!aimed) return std::unexpected(aimed.error());
  return append({*aimed});
}

Faults::Told Faults::tell_rate(std::string_view aim_fault_and_rate) {
  const auto equals = aim_fault_and_rate.rfind('=');
  const std::string_view text = equals == std::string_view::npos ? "" : aim_fault_and_rate.substr(equals + 1);
  double rate = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), rate);
  if (error != std::errc() || end != text.data() + text.size() || !(rate >= 0 && rate <= 1)) {
    return std::unexpected(
        "expected a rate from 0 to 1 at the end, as in reports:record-then-drop=0.1, got '" +
        std::string(aim_fault_and_rate) + "'");
  }
  const auto aimed = read_aimed(aim_fault_and_rate.substr(0, equals));
  if (!aimed) return std::unexpected(aimed.error());
  const std::lock_guard lock(mutex_);
  double sum = rate;
  for (const Rate& other : rates_) sum += other.aim == aimed->first ? other.rate : 0;
  if (sum > 1) {
    return std::unexpected(std::string(kAims[static_cast<std::size_t>(aimed->first)]) +
                           ": the rates come to more than 1");
  }
  rates_.push_back({aimed->first, aimed->second, rate});
  return {};
}

Faults::Told Faults::tell_all(const Json& told) {
  if (!told.is_object()) return std::unexpected(R"(expected an object, as in {"reports": ["drop"]})");
  std::vector<Aimed> aimed;
  for (const auto& [name, list] : told.items()) {
    const auto aim = aim_named(name);
    if (!aim) return std::unexpected(no_such_aim(name));
    if (!list.is_array()) return std::unexpected(name + ": expected an array of faults");
    for (std::size_t i = 0; i < list.size(); ++i) {
      const std::string where = name + "[" + std::to_string(i) + "]: ";
      if (!list[i].is_string()) return std::unexpected(where + R"(expected a text, as in "drop")");
      const auto fault = read_fault(list[i].get_ref<const std::string&>());
      if (!fault) return std::unexpected(where + fault.error());
      aimed.emplace_back(*aim, *fault);
    }
  }
  return append(aimed);
}

void Faults::clear() {
  const std::lock_guard lock(mutex_);
  for (auto& queue : queues_) queue.clear();
  rates_.clear();
  remaining_offset_ = 0;
}

Fault Faults::at_random(Aim aim) {
  constexpr double part = 0x1p-53;  // the upper 53 bits as a number from 0 to 1
  if (std::ranges::find(rates_, aim, &Rate::aim) == rates_.end()) return {};
  double drawn = static_cast<double>(chance_() >> 11) * part;
  for (const Rate& rate : rates_) {
    if (rate.aim != aim) continue;
    if (drawn < rate.rate) return rate.fault;
    drawn -= rate.rate;
  }
  return {};
}

Fault Faults::next(Aim aim) {
  const std::lock_guard lock(mutex_);
  Fault fault;
  if (queue(aim).empty()) {
    fault = at_random(aim);
  } else {
    fault = queue(aim).front();
    queue(aim).pop_front();
  }
  if (fault.times > 1) {
    --fault.times;
    queue(aim).push_front(fault);
    fault.times = 1;
  }
  if (fault.remaining) {
    remaining_offset_ = *fault.remaining;
  } else if (aim == Aim::Status && remaining_offset_ != 0) {
    fault.remaining = remaining_offset_;
  }
  return fault;
}

OrderedJson Faults::left() const {
  const std::lock_guard lock(mutex_);
  OrderedJson left;
  for (std::size_t i = 0; i < kAims.size(); ++i) {
    OrderedJson& list = left[std::string(kAims[i])] = OrderedJson::array();
    for (const Fault& fault : queues_[i]) list.push_back(words_of(fault));
  }
  OrderedJson& rates = left["rates"] = OrderedJson::array();
  for (const Rate& rate : rates_) {
    rates.push_back({{"aim", kAims[static_cast<std::size_t>(rate.aim)]},
                     {"fault", words_of(rate.fault)},
                     {"rate", rate.rate}});
  }
  left["remaining_offset"] = remaining_offset_;
  return left;
}

}  // namespace adit::rehearsal
