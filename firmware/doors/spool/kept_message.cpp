#include "spool/kept_message.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <vector>

#include "codec/body_decoder.hpp"
#include "codec/read.hpp"
#include "codec/write.hpp"
#include "host/files.hpp"
#include "host/log.hpp"
#include "host/service.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"
#include "loop/regular_file.hpp"

namespace adit::spool {
namespace {

constexpr std::size_t kSmall = 4096;  // bytes: larger files are mapped

std::expected<MappedFile, int> map_open_file(int fd) {
  struct stat status{};
  if (::fstat(fd, &status) != 0) return std::unexpected(errno);
  if (status.st_size == 0) return MappedFile{};
  const auto size = static_cast<std::size_t>(status.st_size);
  void* const begin = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, fd, 0);
  if (begin == MAP_FAILED) return std::unexpected(errno);
  const auto unmap = [size](void* mapped) { ::munmap(mapped, size); };
  return MappedFile{std::shared_ptr<void>(begin, unmap), {static_cast<const std::uint8_t*>(begin), size}};
}

std::span<const std::uint8_t> as_bytes(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace

std::expected<MappedFile, int> map_file(const std::string& path) {
  const loop::FileDescriptor fd = loop::open_regular(path, O_RDONLY);
  if (!fd) return std::unexpected(errno);
  auto small = loop::read_all(fd, kSmall);
  if (!small && small.error() != EFBIG) return std::unexpected(small.error());
  if (!small) return map_open_file(fd.get());
  const auto owner = std::make_shared<std::string>(std::move(*small));
  return MappedFile{owner, as_bytes(*owner)};
}

std::string_view text_in(const MappedFile& file) {
  return {reinterpret_cast<const char*>(file.bytes.data()), file.bytes.size()};
}

icd::Refusal unreadable(const std::string& path, int error) {
  const auto status = error == ENOENT ? icd::Status::UnprocessableEntity : icd::Status::ServiceUnavailable;
  return {status, icd::sentence("cannot read ", path, ": ", loop::text_of(error))};
}

PartFile::PartFile(const std::string& path)
    : part_(path + ".XXXXXX" + std::string(kEnding)),
      fd_(::mkostemps(part_.data(), static_cast<int>(kEnding.size()), O_CLOEXEC)) {
  if (!fd_) error_ = errno;
}

PartFile::~PartFile() {
  if (fd_ && !named_) ::unlink(part_.c_str());
}

int PartFile::append(icd::ChunkedBytes& bytes) {
  while (!bytes.empty()) {
    const auto chunk = *bytes.chunks().front();
    if (const int error = append({reinterpret_cast<const char*>(chunk.data()), chunk.size()}); error != 0)
      return error;
    bytes.pop_front();
  }
  return error_;
}

int PartFile::append(std::string_view bytes) {
  const int error = write(bytes, size_);
  if (error == 0) size_ += bytes.size();
  return error;
}

int PartFile::write(std::string_view bytes, std::size_t place) const {
  return error_ != 0 ? error_ : loop::write_all(fd_.get(), bytes, place);
}

std::expected<MappedFile, int> PartFile::map() const {
  return map_open_file(fd_.get());
}

int PartFile::name(const std::string& path) {
  if (error_ != 0) return error_;
  if (std::rename(part_.c_str(), path.c_str()) != 0) return errno;
  named_ = true;
  return 0;
}

namespace {

constexpr std::size_t kBefore = codec::DataFirst::kBefore;

icd::ChunkedBytes data_in(const MappedFile& file, std::size_t size) {
  icd::ChunkedBytes data;
  if (file.owner) data.append(file.owner, file.bytes.subspan(kBefore, size));
  return data;
}

}  // namespace

MapFile::MapFile(const std::string& path) : file_(path), error_(file_.append(std::string(kBefore, '\0'))) {}

std::size_t MapFile::stored_bytes() const {
  return file_.size() - std::min(file_.size(), kBefore);
}

icd::ChunkedBytes MapFile::mapped_bytes() {
  shown_ = file_.map().value_or(MappedFile{});
  return data_in(shown_, stored_bytes());
}

bool MapFile::is_prefix_of(const icd::ChunkedBytes& data) const {
  std::size_t ours = 0;
  for (const auto& chunk : data.chunks()) {
    if (chunk.owner() != shown_.owner) break;
    ours += chunk->size();
  }
  return shown_.owner && ours == stored_bytes();
}

int MapFile::finish(icd::MapUpdate& map, const std::string& path) {
  const codec::DataFirst message = codec::write_data_first(map);
  const std::size_t size = map.data.bytes.size();
  for (std::size_t left = stored_bytes(); left > 0;) left -= map.data.bytes.pop_front()->size();
  int error = append(map.data.bytes);
  if (error == 0) error = file_.append(message.after);
  if (error == 0) error = file_.begin_with(message.before);
  if (error != 0) return error;
  const auto whole = file_.map();
  if (!whole) return whole.error();
  error = file_.name(path);
  if (error == 0) map.data.bytes = data_in(*whole, size);
  return error;
}

icd::Checked<icd::MapUpdate> MapFile::read(const std::string& path, const icd::Rules& rules) {
  const auto file = map_file(path);
  if (!file) return std::unexpected(unreadable(path, file.error()));
  if (file->bytes.size() < kBefore) return icd::unprocessable("the file is cut short");
  const std::string_view text = text_in(*file);
  const std::string_view before = text.substr(0, kBefore);
  const std::uint64_t size = codec::data_after(before);
  if (size > text.size() - kBefore) return icd::unprocessable("the file is cut short");
  return codec::read_data_first(before, data_in(*file, size), text.substr(kBefore + size), rules);
}

namespace {

namespace fs = std::filesystem;

/// Largest message without its bulk data: larger than any accepted one.
constexpr std::size_t kMostText = 64u << 20;

icd::Rules kept_rules() {
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

std::expected<void, std::string> replace_file(const std::string& path, icd::ChunkedBytes bytes) {
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
              {{"why", host::path_error(folder, read.error())}});
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
  return MapFile::read(path, kept_rules());
}

icd::Checked<icd::StateUpdate> read_state(const std::string& path) {
  const auto document = ADIT_TRY(decode(path, codec::Split::Nothing));
  return codec::read_state_update(document, kept_rules());
}

icd::Checked<icd::MarkersUpdate> read_markers(const std::string& path) {
  const auto document = ADIT_TRY(decode(path, codec::Split::Lists));
  return codec::read_markers_update(document, kept_rules());
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
  const auto own = icd::GridBounds::from_grid(grid);
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
