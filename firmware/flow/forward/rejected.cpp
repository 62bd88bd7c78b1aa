#include "forward/rejected.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>

#include "codec/field.hpp"
#include "codec/json.hpp"
#include "codec/write.hpp"
#include "forward/traffic_counts.hpp"
#include "host/files.hpp"
#include "host/log.hpp"
#include "host/service.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"
#include "spool/kept_message.hpp"

namespace adit::forward {
namespace {

namespace fs = std::filesystem;
using codec::Value;

constexpr const char *kMessage = ".cbor", *kReason = ".json";

std::expected<void, std::string> write_message(const std::string& path, icd::MapUpdate map) {
  const int error = spool::MapFile(path).finish(map, path);
  if (error == 0) return {};
  return std::unexpected(host::path_error(path, error));
}
std::expected<void, std::string> write_message(const std::string& path, const icd::StateUpdate& state) {
  return spool::replace_file(path, codec::write_state_update(state));
}
std::expected<void, std::string> write_message(const std::string& path, const icd::MarkersUpdate& markers) {
  return spool::replace_file(path, codec::write_markers_update(markers));
}

constexpr std::string_view kKinds[] = {"map", "state", "markers"};  // in the order of queues::Message

std::string reason_of(const queues::RejectedMessage& item, bool replaced) {
  Value::Object members{{"kind", {std::string(kKinds[item.message.index()])}},
                        {"status", {std::int64_t{item.status}}},
                        {"why", {item.why}},
                        {"at", {item.at}},
                        {"bytes", {static_cast<std::uint64_t>(item.bytes)}},
                        {"replaced", {replaced}}};
  if (item.bounds) members.emplace_back("bounds", spool::to_json(*item.bounds));
  if (item.faults > 0) members.push_back({"faults", {std::int64_t{item.faults}}});
  return codec::write_json({std::move(members)});
}

icd::ChunkedBytes text_bytes(const std::string& text) {
  return icd::ChunkedBytes({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

/// A message's files, and its new reason.
struct Files {
  std::string reason, message, text;
};

void remove(const std::string& reason, const std::string& message) {
  std::error_code error;
  fs::remove(reason, error);
  fs::remove(message, error);
}

/// A full disk deletes the message, because a newer one contains it.
void write_replaced(const Files& files) {
  if (!spool::replace_file(files.reason, text_bytes(files.text))) remove(files.reason, files.message);
}

template <class Message>
icd::Checked<queues::Message> any(icd::Checked<Message> message) {
  if (!message) return std::unexpected(std::move(message.error()));
  return queues::Message(std::move(*message));
}

icd::Checked<queues::Message> read_message(const std::string& path, std::string_view kind) {
  if (kind == kKinds[0]) return any(spool::read_map(path));
  if (kind == kKinds[1]) return any(spool::read_state(path));
  if (kind == kKinds[2]) return any(spool::read_markers(path));
  return icd::unprocessable("kind: expected map, state or markers");
}

/// Reads the reason from the file at `path`, and the message beside it. 503: unreadable. Otherwise: damaged.
icd::Checked<queues::RejectedMessage> read_item(const std::string& path, const std::string& message) {
  const auto file = spool::map_file(path);
  if (!file) return std::unexpected(spool::unreadable(path, file.error()));
  const auto value = codec::parse_json(spool::text_in(*file));
  if (!value) return icd::unprocessable(value.error());
  codec::Reading reading;
  const codec::Field root(*value, reading);
  queues::RejectedMessage item;
  const std::string kind(root.member("kind").text());
  item.status = static_cast<int>(root.member("status").integer(0, 999));
  item.why = root.member("why").text();
  item.at = root.member("at").number();
  item.bytes = static_cast<std::size_t>(root.member("bytes").integer<std::int64_t>(0, std::int64_t{1} << 40));
  item.replaced = root.member("replaced").truth();
  item.message = ADIT_TRY(read_message(message, kind));
  const codec::Field bounds = root.member("bounds"), faults = root.member("faults");
  if (!faults.is_absent()) item.faults = static_cast<int>(faults.integer(1, 1 << 30));
  const auto* const map = std::get_if<icd::MapUpdate>(&item.message);
  if (map != nullptr && map->is_grid() && !bounds.is_absent())
    item.bounds = spool::read_bounds(bounds, std::get<icd::OccupancyGrid>(map->msg));
  return reading.outcome(std::move(item));
}

std::string sender_text(const queues::Message& message) {
  if (const auto* map = std::get_if<icd::MapUpdate>(&message)) return icd::text_of(map->name);
  const auto* state = std::get_if<icd::StateUpdate>(&message);
  return state != nullptr && state->poses.size() == 1 ? state->poses.front().name.text() : "";
}

std::string kind_of(const queues::Message& message) {
  if (const auto* map = std::get_if<icd::MapUpdate>(&message)) return map->is_grid() ? "grid" : "cloud";
  return std::string(kKinds[message.index()]);
}

std::string not_found(std::uint64_t number) {
  return icd::sentence("there is no rejected message ", number);
}

}  // namespace

RejectedStore::RejectedStore(const loop::Loop& loop, loop::Writer& writer, std::string folder)
    : loop_(loop), writer_(writer), folder_(std::move(folder)) {
  spool::make_folder_of_ours(folder_);
}

std::string RejectedStore::path(std::uint64_t number, const char* ending) const {
  return folder_ + "/" + std::to_string(number) + ending;
}

void RejectedStore::restore() {
  spool::remove_parts(folder_);
  const auto numbers = host::numbers_in(folder_, "", kReason);
  unread_ = numbers ? "" : numbers.error();
  for (const std::uint64_t number : numbers.value_or(std::vector<std::uint64_t>())) {
    const auto restored = restore_one(number);
    if (restored) continue;
    if (restored.error().status == icd::Status::ServiceUnavailable) {
      unread_ = restored.error().sentence;
      continue;
    }
    for (const char* const ending : {kMessage, kReason})
      host::set_damaged_aside(path(number, ending), "a rejected message", restored.error().sentence);
    if (missing_.empty())
      missing_ = icd::sentence("rejected messages are damaged: ", path(number, kMessage), ": ",
                               restored.error().sentence);
  }
  if (unread_.empty()) return;
  host::log(host::Level::Error, "rejected messages cannot be read", {{"why", unread_}});
  missing_ = "rejected messages cannot be read: " + unread_;
}

icd::Checked<void> RejectedStore::restore_one(std::uint64_t number) {
  auto item = ADIT_TRY(read_item(path(number, kReason), path(number, kMessage)));
  item.number = number;
  items_.restore(std::move(item));
  return {};
}

void RejectedStore::add(queues::Message message, int status, const std::string& why, std::size_t bytes,
                        Origin origin, const std::optional<icd::GridBounds>& bounds, int faults) {
  queues::RejectedMessage item{.message = std::move(message),
                               .status = status,
                               .why = why,
                               .at = loop_.stamp_now(),
                               .bytes = bytes,
                               .bounds = bounds,
                               .faults = faults};
  host::log(faults > 0 ? host::Level::Error : host::Level::Warning,
            faults > 0 ? "a map is put aside; it is kept" : "the Command Post rejected a message; it is kept",
            {{"kind", kind_of(item.message)},
             {"robot", sender_text(item.message)},
             {"status", std::to_string(status)},
             {"why", why}});
  const auto said_again = [&](std::uint64_t number) {
    const queues::RejectedMessage* const older = items_.find(number);
    return older == nullptr || older->replaced || queues::replaces(item.message, *older);
  };
  std::vector<std::uint64_t> covered;
  for (const queues::RejectedMessage& older : items_.items()) {
    if (said_again(older.number)) covered.push_back(older.number);
  }
  for (const std::uint64_t gone : items_.add(std::move(item))) {
    if (std::ranges::find(covered, gone) == covered.end()) ++dropped_;
    forget(gone);
  }
  keep(items_.items().back(), std::move(origin));
}

void RejectedStore::keep(const queues::RejectedMessage& item, Origin origin) {
  const auto well = std::make_shared<bool>(false);
  writer_.submit(
      [well, message = item.message, reason = reason_of(item, item.replaced), unread = unread_,
       message_file = path(item.number, kMessage), reason_file = path(item.number, kReason)] {
        std::expected<void, std::string> written;
        if (!unread.empty()) written = std::unexpected(unread);
        if (written)
          written = std::visit([&](const auto& each) { return write_message(message_file, each); }, message);
        if (written) written = spool::replace_file(reason_file, text_bytes(reason));
        *well = written.has_value();
        if (*well) return;
        host::log(host::Level::Warning, "a rejected message is kept in memory only",
                  {{"why", written.error()}});
      },
      [this, well, number = item.number, origin = std::move(origin)] { on_stored(number, *well, origin); });
  ++being_written_;
}

void RejectedStore::on_stored(std::uint64_t number, bool well, const Origin& origin) {
  --being_written_;
  origin.on_stored(well);
  const queues::RejectedMessage* const item = items_.find(number);
  if (well || item == nullptr || item->replaced) return origin.release();
  in_memory_[number] = origin.release;
}

void RejectedStore::forget(std::uint64_t number) {
  if (unread_.empty())
    writer_.submit(
        [reason = path(number, kReason), message = path(number, kMessage)] { remove(reason, message); },
        [] {});
  leaving_.erase(number);
  release_origin(number);
}

void RejectedStore::release_origin(std::uint64_t number) {
  const auto origin = in_memory_.find(number);
  if (origin == in_memory_.end()) return;
  origin->second();
  in_memory_.erase(origin);
}

bool RejectedStore::mark_contained(const queues::Message& message, std::function<void()> written) {
  const std::vector<std::uint64_t> replaced = items_.replaced_by(message);
  std::vector<Files> all;
  for (const std::uint64_t number : replaced) {
    if (in_memory_.contains(number)) continue;
    all.push_back({path(number, kReason), path(number, kMessage), reason_of(*items_.find(number), true)});
  }
  for (const std::uint64_t number : replaced) release_origin(number);
  if (!all.empty()) {
    writer_.submit([all] { std::ranges::for_each(all, write_replaced); },
                   [this, written = std::move(written)] {
                     --being_written_;
                     written();
                   });
    ++being_written_;
  }
  items_.mark_replaced(replaced);
  return !all.empty();
}

std::expected<queues::RejectedMessage, std::string> RejectedStore::begin_resend(std::uint64_t number) {
  const queues::RejectedMessage* const item = items_.find(number);
  if (item == nullptr || leaving_.contains(number)) return std::unexpected(not_found(number));
  if (item->replaced) {
    return std::unexpected(
        "a newer message that contains it was delivered since; sent now, it would replace the newer message");
  }
  leaving_.insert(number);
  return *item;
}

bool RejectedStore::finish_resend(std::uint64_t number, bool kept) {
  const queues::RejectedMessage* const item = items_.find(number);
  const bool is_wanted = item == nullptr || !item->replaced;
  if (kept && items_.extract(number)) {
    forget(number);
  } else {
    leaving_.erase(number);
  }
  return is_wanted;
}

std::expected<void, std::string> RejectedStore::discard(std::uint64_t number) {
  if (leaving_.contains(number) || !items_.extract(number)) return std::unexpected(not_found(number));
  forget(number);
  return {};
}

std::string RejectedStore::put_aside() const {
  std::string all;
  for (const queues::RejectedMessage& item : items_.items()) {
    if (item.faults == 0 || item.replaced || leaving_.contains(item.number)) continue;
    const std::string robot = sender_text(item.message);
    all += icd::sentence(all.empty() ? "" : "; ", "message ", item.number, ", ",
                         robot.empty() ? "" : robot + "'s ", kind_of(item.message), ": ", item.why);
  }
  return all;
}

std::vector<facts::RejectedRow> RejectedStore::rows() const {
  std::vector<facts::RejectedRow> rows;
  for (const queues::RejectedMessage& item : items_.items()) {
    if (leaving_.contains(item.number)) continue;
    rows.push_back({.number = item.number,
                    .kind = kind_of(item.message),
                    .robot = sender_text(item.message),
                    .at = item.at + (loop_.wall_now() - loop_.stamp_now()),
                    .status = item.status,
                    .why = item.why,
                    .bytes = item.bytes,
                    .replaced = item.replaced});
  }
  return rows;
}

}  // namespace adit::forward
