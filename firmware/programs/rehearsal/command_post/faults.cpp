#include "rehearsal/command_post/faults.hpp"

#include <algorithm>
#include <charconv>

namespace adit::rehearsal {
namespace {

constexpr const char* kClock = "clock";
constexpr std::string_view kClockAim = "clock:";
constexpr const char* kConstant = "constant";
constexpr const char* kRunning = "running";
constexpr const char* kTooMany = "at most 10000 faults can be queued";

std::optional<Aim> aim_named(std::string_view name) {
  const auto* const found = std::ranges::find(kAims, name);
  if (found == kAims.end()) return std::nullopt;
  return static_cast<Aim>(found - kAims.begin());
}

std::string no_such_aim(std::string_view name) {
  constexpr std::size_t longest = 80;
  return std::string("no such aim: '")
      .append(name.substr(0, longest))
      .append("'; there are reports, status, mapping, clock");
}

/// Whether the fault may happen to the request of that body: one of its robot, or of any.
bool is_of(const Fault& fault, std::string_view body) {
  return fault.robot.empty() || body.find(fault.robot) != std::string_view::npos;
}

/// Of the word behind "clock:".
std::expected<bool, std::string> clocks_stand_by(std::string_view word) {
  if (word == kConstant) return true;
  if (word == kRunning) return false;
  constexpr std::size_t longest = 80;
  return std::unexpected(
      std::string("expected constant or running, got '").append(word.substr(0, longest)).append("'"));
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

Faults::Told Faults::obey(const Orders& orders) {
  const std::lock_guard lock(mutex_);
  std::size_t waiting = orders.aimed.size();
  for (const auto& queue : queues_) waiting += queue.size();
  if (waiting > kMost) return std::unexpected(kTooMany);
  for (const auto& [aim, fault] : orders.aimed) queue(aim).push_back(fault);
  clocks_stand_ = orders.clocks_stand.value_or(clocks_stand_);
  return {};
}

Faults::Told Faults::tell(std::string_view aim_and_fault) {
  if (aim_and_fault.starts_with(kClockAim)) {
    const auto stand = clocks_stand_by(aim_and_fault.substr(kClockAim.size()));
    if (!stand) return std::unexpected("clock: " + stand.error());
    return obey({.aimed = {}, .clocks_stand = *stand});
  }
  const auto aimed = read_aimed(aim_and_fault);
  if (!aimed) return std::unexpected(aimed.error());
  return obey({.aimed = {*aimed}, .clocks_stand = {}});
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

/// The array `list` that stands under `name`.
Faults::Told Faults::read_list(const std::string& name, const Json& list, Orders& orders) {
  const bool of_clocks = name == kClock;
  const auto aim = aim_named(name);
  if (!aim && !of_clocks) return std::unexpected(no_such_aim(name));
  if (!list.is_array()) return std::unexpected(name + ": expected an array of faults");
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string where = name + "[" + std::to_string(i) + "]: ";
    if (!list[i].is_string()) return std::unexpected(where + R"(expected a text, as in "drop")");
    const auto& words = list[i].get_ref<const std::string&>();
    if (of_clocks) {
      const auto stand = clocks_stand_by(words);
      if (!stand) return std::unexpected(where + stand.error());
      orders.clocks_stand = *stand;
    } else {
      const auto fault = read_fault(words);
      if (!fault) return std::unexpected(where + fault.error());
      orders.aimed.emplace_back(*aim, *fault);
    }
  }
  return {};
}

Faults::Told Faults::tell_all(const Json& told) {
  if (!told.is_object()) return std::unexpected(R"(expected an object, as in {"reports": ["drop"]})");
  Orders orders;
  for (const auto& [name, list] : told.items()) {
    if (const auto read = read_list(name, list, orders); !read) return read;
  }
  return obey(orders);
}

void Faults::clear() {
  const std::lock_guard lock(mutex_);
  for (auto& queue : queues_) queue.clear();
  until_ = {};
  rates_.clear();
  remaining_offset_ = 0;
  clocks_stand_ = false;
}

/// One that is to happen to more than one request waits for the others, as if it had been told just now.
Fault Faults::at_random(Aim aim, std::string_view body, Clock::time_point now) {
  constexpr double part = 0x1p-53;  // the upper 53 bits as a number from 0 to 1
  if (std::ranges::find(rates_, aim, &Rate::aim) == rates_.end()) return {};
  double drawn = static_cast<double>(chance_() >> 11) * part;
  for (const Rate& rate : rates_) {
    if (rate.aim != aim) continue;
    if (drawn >= rate.rate) {
      drawn -= rate.rate;
      continue;
    }
    if (!is_of(rate.fault, body)) return {};
    if (rate.fault.times == 1 && !rate.fault.lasts) return rate.fault;
    queue(aim).push_front(rate.fault);
    return *from_queue(aim, body, now);
  }
  return {};
}

/// The first in the queue that has not lasted for its time, and whose robot's this is; nothing: none waits.
std::optional<Fault> Faults::from_queue(Aim aim, std::string_view body, Clock::time_point now) {
  auto& waiting = queue(aim);
  auto& until = until_[static_cast<std::size_t>(aim)];
  if (until && now >= *until) {
    waiting.pop_front();
    until.reset();
  }
  if (waiting.empty()) return std::nullopt;
  Fault& front = waiting.front();
  if (front.lasts && !until) until = now + std::chrono::duration_cast<Clock::duration>(*front.lasts);
  if (!is_of(front, body)) return Fault{};
  Fault fault = front;
  fault.times = 1;
  if (front.lasts) return fault;
  if (--front.times == 0) waiting.pop_front();
  return fault;
}

Fault Faults::next(Aim aim, std::string_view body, Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  const auto waited = from_queue(aim, body, now);
  Fault fault = waited ? *waited : at_random(aim, body, now);
  if (fault.remaining) {
    remaining_offset_ = *fault.remaining;
  } else if (aim == Aim::Status && remaining_offset_ != 0) {
    fault.remaining = remaining_offset_;
  }
  fault.clock_stands = clocks_stand_ && aim != Aim::Mapping;
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
  left[kClock] = clocks_stand_ ? kConstant : kRunning;
  return left;
}

}  // namespace adit::rehearsal
