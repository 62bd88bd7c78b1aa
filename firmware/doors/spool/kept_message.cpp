#include "spool/kept_message.hpp"

#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <vector>

#include "codec/body_decoder.hpp"
#include "codec/read.hpp"
#include "host/files.hpp"
#include "host/log.hpp"
#include "host/service.hpp"
#include "icd/try.hpp"
#include "spool/map_file.hpp"

namespace adit::spool {
namespace {

namespace fs = std::filesystem;

/// Largest message without its bulk data: larger than any accepted one.
constexpr std::size_t kMostText = 64u << 20;

icd::Rules as_kept() {
  return {.map_bytes = icd::kMostMapBytes};
}

icd::Checked<codec::Document> decode(const std::string& path, codec::Split split) {
  const auto file = map_file(path);
  if (!file) return std::unexpected(unreadable(path, file.error()));
  return codec::decode({codec::Format::Cbor}, split, text_in(*file), {.text_bytes = kMostText});
}

}  // namespace

void make_folder_of_ours(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  fs::permissions(folder, fs::perms::owner_all, error);
}

std::expected<void, std::string> write_whole(const std::string& path, icd::ChunkedBytes bytes) {
  PartFile file(path);
  int error = file.append(bytes);
  if (error == 0) error = file.name(path);
  if (error == 0) return {};
  return std::unexpected(path + ": " + std::system_category().message(error));
}

void remove_parts(const std::string& folder) {
  std::vector<std::string> parts;
  const auto read = host::for_each_name(folder, [&](std::string_view name) {
    if (name.ends_with(PartFile::kEnding)) parts.push_back(folder + '/' + std::string(name));
    return true;
  });
  if (!read && read.error() != ENOENT)
    host::log(host::Level::Warning, "unfinished files may remain",
              {{"why", host::trouble(folder, read.error())}});
  for (const std::string& part : parts) ::unlink(part.c_str());
}

bool can_be_read(const std::string& folder) {
  bool can = true;
  const auto listed = host::for_each_name(folder, [&](std::string_view name) {
    can = name.ends_with(host::kDamaged) || map_file(folder + '/' + std::string(name));
    return can;
  });
  return can && (listed || listed.error() == ENOENT);
}

icd::Checked<icd::MapUpdate> read_map(const std::string& path) {
  return MapFile::read(path, as_kept());
}

icd::Checked<icd::StateUpdate> read_state(const std::string& path) {
  const auto document = ADIT_TRY(decode(path, codec::Split::Nothing));
  return codec::read_state_update(document, as_kept());
}

icd::Checked<icd::MarkersUpdate> read_markers(const std::string& path) {
  const auto document = ADIT_TRY(decode(path, codec::Split::Lists));
  return codec::read_markers_update(document, as_kept());
}

codec::Value to_json(const icd::GridBounds& bounds) {
  codec::Value::Array numbers;
  for (const icd::Point& corner : {bounds.low, bounds.high}) {
    for (const double metres : {corner.x, corner.y, corner.z}) numbers.push_back({metres});
  }
  numbers.push_back({bounds.turned});
  return {std::move(numbers)};
}

icd::GridBounds read_bounds(const codec::Field& field, const icd::OccupancyGrid& grid) {
  constexpr std::size_t kNumbers = 7;
  const auto own = icd::GridBounds::of(grid);
  if (field.size() != kNumbers) {
    field.refuse("expected ", kNumbers, " numbers");
    return own;
  }
  const auto number = [&](std::size_t i) { return field.element(i).number(); };
  icd::GridBounds kept = own;
  kept.low = {number(0), number(1), number(2)};
  kept.high = {number(3), number(4), number(5)};
  kept.turned = number(6);
  return icd::joint_bounds(own, kept);
}

}  // namespace adit::spool
