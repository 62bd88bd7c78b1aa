#include "spool/spool.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string_view>

#include "codec/json.hpp"
#include "host/disk.hpp"
#include "host/files.hpp"
#include "host/log.hpp"
#include "host/service.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"
#include "spool/kept_message.hpp"

namespace adit::spool {
namespace {

namespace fs = std::filesystem;

/// Bytes of a map's file beside the data, in whole pages.
constexpr std::uint64_t kBeside = 8192;
/// Most bytes of put_aside(), beside its last map. The log names all.
constexpr std::size_t kMostTold = 300;
constexpr std::string_view kMap = "map-", kEnding = ".cbor", kBounds = ".bounds";
constexpr char kFault = 'x';  // of loop::FaultCounter

std::unexpected<icd::Refusal> storage_refusal(const std::string& why) {
  return std::unexpected(icd::Refusal{icd::Status::ServiceUnavailable,
                                      "Adit cannot store this map: " + why + "; send it again later"});
}

/// True if each try to read the file fails with an error that does not pass. Lack of descriptors or memory
/// and errors of the disk may pass.
bool is_unreadable(const std::string& path) {
  constexpr int kTries = 3;
  constexpr int kPassing[] = {EMFILE, ENFILE, ENOMEM, EIO, EAGAIN, EINTR};
  for (int i = 0; i < kTries; ++i) {
    const auto file = spool::map_file(path);
    if (file || std::ranges::find(kPassing, file.error()) != std::end(kPassing)) return false;
  }
  return true;
}

/// Bytes left for maps in the file system, or errno.
std::expected<std::uint64_t, int> room_in(const std::string& folder, std::uint64_t left_to_others) {
  const auto disk = host::disk_of(folder);
  if (!disk) return std::unexpected(errno);
  return disk->free - std::min({disk->free, left_to_others, disk->all / 4});
}

}  // namespace

Spool::Spool(std::string folder, std::uint64_t left_to_others)
    : folder_(std::move(folder)), left_to_others_(left_to_others) {
  make_folder_of_ours(folder_);
}

Spool::~Spool() {
  at_work_.clear();
  write_work();
}

std::string Spool::trouble() const {
  if (!unread_.empty()) return unread_;
  if (::access(folder_.c_str(), W_OK | X_OK) == 0) return "";
  return folder_ + ": " + std::strerror(errno);
}

std::string Spool::file_of(std::uint64_t number) const {
  return folder_ + "/" + host::numbered_name(kMap, number, kEnding);
}

std::string Spool::bounds_file_of(std::uint64_t number) const {
  return folder_ + "/" + host::numbered_name(kMap, number, kBounds);
}

bool Spool::has_room(std::uint64_t bytes) const {
  const auto room = room_in(folder_, left_to_others_);
  return room && *room >= bytes;
}

icd::Checked<icd::MapUpdate> Spool::keep(std::uint64_t number, icd::MapUpdate map, std::uint64_t spare,
                                         std::shared_ptr<MapFile> begun) {
  if (!unread_.empty()) return storage_refusal(unread_);
  if (::access(folder_.c_str(), F_OK) != 0) make_folder_of_ours(folder_);
  const std::string path = file_of(number);
  if (!begun || !begun->is_prefix_of(map.data.bytes)) begun = std::make_shared<MapFile>(path);
  const auto room = room_in(folder_, left_to_others_);
  if (!room) return storage_refusal(folder_ + ": " + std::strerror(room.error()));
  if (*room < map.data.bytes.size() - begun->stored_bytes() + kBeside + spare) {
    return storage_refusal(icd::sentence("the room for queued maps is full (", *room / 1000000, " MB left)"));
  }
  if (const int error = begun->finish(map, path); error != 0)
    return storage_refusal(path + ": " + std::strerror(error));
  return map;
}

bool Spool::keep_bounds(std::uint64_t number, const icd::GridBounds& bounds) const {
  const auto text = codec::write_json(to_json(bounds));
  const auto written =
      replace_file(bounds_file_of(number),
                   icd::ChunkedBytes({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}));
  if (!written)
    host::log(host::Level::Warning, "cannot store what a grid replaced; the older grids stay stored",
              {{"why", written.error()}});
  return written.has_value();
}

/// The bounds go first, so that they never belong to a later map of that number.
void Spool::forget(std::uint64_t number) {
  std::error_code error;
  fs::remove(bounds_file_of(number), error);
  fs::remove(file_of(number), error);
  if (error)
    host::log(host::Level::Warning, "the file of a map that is not queued any more remains",
              {{"file", file_of(number)}, {"why", error.message()}});
}

void Spool::set_aside(std::uint64_t number, const std::string& why) {
  ::unlink(bounds_file_of(number).c_str());
  host::set_damaged_aside(file_of(number), "a queued map", why);
}

void Spool::put_aside(std::uint64_t number, const std::string& why) {
  set_aside(number, why);
  if (put_aside_.size() < kMostTold)
    put_aside_ += icd::sentence(put_aside_.empty() ? "" : "; ", file_of(number), ": ", why);
}

void Spool::begin_work(std::vector<std::uint64_t> numbers) {
  at_work_ = std::move(numbers);
  write_work();
}

void Spool::end_work(bool are_packed) {
  if (are_packed) {
    for (const std::uint64_t number : at_work_) ends_.erase(number);
  }
  at_work_.clear();
  write_work();
}

void Spool::record_overrun() const {
  std::ofstream(work_file(), std::ios::app) << kFault;
}

void Spool::remember(std::uint64_t number, const EndCounts& ends) {
  ends_[number] = ends;
  if (at_work_.empty()) write_work();  // else its fault counter has the file open
}

void Spool::forget_ends(std::span<const std::uint64_t> numbers) {
  std::size_t forgotten = 0;
  for (const std::uint64_t number : numbers) forgotten += ends_.erase(number);
  if (forgotten > 0 && at_work_.empty()) write_work();
}

/// A line for each map: number, faults, other ends, and 1 if it is being packed. A fault appends kFault.
/// Without the file, the end of this process is not counted.
void Spool::write_work() {
  std::string text;
  const auto add = [&](std::uint64_t number, const EndCounts& ends, bool is_at_work) {
    text += icd::sentence(number, " ", ends.faults, " ", ends.others, " ", is_at_work ? 1 : 0, "\n");
  };
  for (const std::uint64_t number : at_work_) {
    const auto found = ends_.find(number);
    add(number, found == ends_.end() ? EndCounts() : found->second, true);
  }
  for (const auto& [number, ends] : ends_) {
    if (std::ranges::find(at_work_, number) == at_work_.end()) add(number, ends, false);
  }
  if (text.empty() || !host::write_file(work_file(), text, host::kOursAlone)) ::unlink(work_file().c_str());
}

/// Reads how often processes ended while they packed each map, and counts the end of the last one.
void Spool::count_ends() {
  if (!host::can_exist(work_file())) return;
  const auto text = host::read_file(work_file());
  if (!text)
    return host::log(host::Level::Warning, "cannot read which map was packed", {{"why", text.error()}});
  const bool was_fault = text->ends_with(kFault);
  std::istringstream lines(*text);
  std::uint64_t number = 0;
  EndCounts ends;
  for (int was_at_work = 0; lines >> number >> ends.faults >> ends.others >> was_at_work;) {
    if (was_at_work != 0) ++(was_fault ? ends.faults : ends.others);
    if (host::can_exist(file_of(number))) ends_[number] = ends;
  }
  write_work();
}

/// Damaged bounds are ignored: the map is stored all the same.
icd::Checked<Spool::KeptMap> Spool::read(std::uint64_t number) const {
  KeptMap kept{.number = number, .map = ADIT_TRY(read_map(file_of(number)))};
  if (const auto ends = ends_.find(number); ends != ends_.end()) kept.ends = ends->second;
  const std::string path = bounds_file_of(number);
  const auto* const grid = std::get_if<icd::OccupancyGrid>(&kept.map.msg);
  if (grid == nullptr || !host::can_exist(path)) return kept;
  const auto file = map_file(path);
  if (!file)
    return std::unexpected(
        icd::Refusal{icd::Status::ServiceUnavailable, unreadable(path, file.error()).sentence});
  const auto value = codec::parse_json(text_in(*file));
  codec::Reading reading;
  if (value) kept.bounds = read_bounds(codec::Field(*value, reading), *grid);
  if (!value || reading.has_refusal()) {
    kept.bounds.reset();
    host::log(host::Level::Warning, "what a queued grid replaced is unknown: its file is damaged",
              {{"file", path}});
  }
  return kept;
}

Spool::KeptMaps Spool::read() {
  remove_parts(folder_);
  count_ends();
  KeptMaps kept;
  std::map<std::uint64_t, std::string> unreadable;  // why
  const auto numbers = host::numbers_in(folder_, kMap, kEnding);
  unread_ = numbers ? "" : numbers.error();
  for (const std::uint64_t number : numbers.value_or(std::vector<std::uint64_t>())) {
    auto map = read(number);
    if (map) {
      kept.push_back(std::move(*map));
    } else if (map.error().status != icd::Status::ServiceUnavailable) {
      put_aside(number, map.error().sentence);
    } else if (is_unreadable(file_of(number))) {
      unreadable.emplace(number, map.error().sentence);
    } else {
      unread_ = map.error().sentence;
    }
  }
  // If no other map can be read, the cause may lie in the directory.
  if (kept.empty() && !unreadable.empty()) unread_ = unreadable.begin()->second;
  if (unread_.empty()) {
    for (const auto& [number, why] : unreadable) put_aside(number, why);
  }
  if (unread_.empty()) return kept;
  host::log(host::Level::Error, "cannot read queued maps", {{"why", unread_}});
  return {};
}

}  // namespace adit::spool
