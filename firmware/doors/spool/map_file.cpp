#include "spool/map_file.hpp"

#include <algorithm>
#include <string_view>

#include "codec/read.hpp"
#include "codec/write.hpp"
#include "icd/sentence.hpp"

namespace adit::spool {
namespace {

constexpr std::size_t kBefore = codec::DataFirst::kBefore;

icd::ChunkedBytes data_in(const MappedFile& file, std::size_t size) {
  icd::ChunkedBytes data;
  if (file.owner) data.append(file.owner, file.bytes.subspan(kBefore, size));
  return data;
}

}  // namespace

MapFile::MapFile(const std::string& path) : file_(path), error_(file_.append(std::string(kBefore, '\0'))) {}

int MapFile::append(icd::ChunkedBytes& data) {
  return error_ != 0 ? error_ : file_.append(data);
}

std::size_t MapFile::stored_bytes() const {
  return file_.size() - std::min(file_.size(), kBefore);
}

icd::ChunkedBytes MapFile::stored() {
  shown_ = file_.map().value_or(MappedFile{});
  return data_in(shown_, stored_bytes());
}

bool MapFile::begins(const icd::ChunkedBytes& data) const {
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

}  // namespace adit::spool
