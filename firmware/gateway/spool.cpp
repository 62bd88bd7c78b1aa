#include "gateway/spool.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>

#include "codec/body_decoder.hpp"
#include "codec/read.hpp"
#include "codec/write.hpp"
#include "host/log.hpp"

namespace adit::gateway {
namespace {

namespace fs = std::filesystem;

constexpr const char* kState = "state.cbor";
constexpr const char* kMarkers = "markers.cbor";
constexpr const char* kMapPrefix = "map-";

std::string map_file(std::size_t index) {
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "%s%08zu.cbor", kMapPrefix, index);
  return name.data();
}

void write(const fs::path& path, const icd::ChunkedBytes& bytes) {
  std::ofstream file(path, std::ios::binary);
  for (const auto& chunk : bytes.chunks()) {
    file.write(reinterpret_cast<const char*>(chunk->data()), static_cast<std::streamsize>(chunk->size()));
  }
  file.close();
  if (!file) host::log(host::Level::Error, "a waiting message could not be kept", {{"file", path.string()}});
}

icd::Checked<codec::Document> read(const fs::path& path, codec::Split split, const icd::Rules& rules) {
  codec::BodyDecoder decoder({codec::Format::Cbor, codec::ContentCoding::Identity}, split,
                             {.text_bytes = 64u << 20, .data_bytes = rules.map_bytes});
  std::ifstream file(path, std::ios::binary);
  std::vector<char> piece(icd::ChunkedBytes::kChunk);
  while (file.read(piece.data(), static_cast<std::streamsize>(piece.size())) || file.gcount() > 0) {
    const auto fed = decoder.feed(
        {reinterpret_cast<const std::uint8_t*>(piece.data()), static_cast<std::size_t>(file.gcount())});
    if (!fed) return std::unexpected(fed.error());
  }
  return decoder.finish();
}

/// The message in one file; gone afterwards, or set aside where it could not be understood.
template <class Message, class Reader>
std::optional<Message> take_file(const fs::path& path, codec::Split split, const icd::Rules& rules,
                                 const Reader& reader) {
  std::error_code error;
  if (!fs::exists(path, error)) return std::nullopt;
  auto document = read(path, split, rules);
  icd::Checked<Message> message = document ? reader(std::move(*document), rules)
                                           : icd::Checked<Message>(std::unexpected(document.error()));
  if (message) {
    fs::remove(path, error);
    return std::move(*message);
  }
  host::log(host::Level::Error, "a kept message could not be read and is set aside",
            {{"file", path.string()}, {"why", message.error().sentence}});
  fs::rename(path, path.string() + ".damaged", error);
  return std::nullopt;
}

}  // namespace

void Spool::save(const Unsent& unsent) const {
  std::error_code error;
  fs::create_directories(folder_, error);
  fs::permissions(folder_, fs::perms::owner_all, error);
  for (std::size_t i = 0; i < unsent.maps.size(); ++i) {
    write(fs::path(folder_) / map_file(i), codec::write_map_update(unsent.maps[i]));
  }
  if (!unsent.state.poses.empty()) write(fs::path(folder_) / kState, codec::write_state_update(unsent.state));
  if (!unsent.markers.markers.empty()) {
    write(fs::path(folder_) / kMarkers, codec::write_markers_update(unsent.markers));
  }
}

Unsent Spool::take(const icd::Rules& rules) const {
  Unsent unsent;
  std::error_code error;
  std::vector<fs::path> maps;
  for (const auto& file : fs::directory_iterator(folder_, error)) {
    const std::string name = file.path().filename().string();
    if (name.starts_with(kMapPrefix) && name.ends_with(".cbor")) maps.push_back(file.path());
  }
  std::ranges::sort(maps);
  for (const fs::path& path : maps) {
    auto map = take_file<icd::MapUpdate>(path, codec::Split::MapData, rules, codec::read_map_update);
    if (map) unsent.maps.push_back(std::move(*map));
  }
  const fs::path folder(folder_);
  unsent.state =
      take_file<icd::StateUpdate>(folder / kState, codec::Split::Nothing, rules, codec::read_state_update)
          .value_or(icd::StateUpdate{});
  unsent.markers = take_file<icd::MarkersUpdate>(folder / kMarkers, codec::Split::Nothing, rules,
                                                 codec::read_markers_update)
                       .value_or(icd::MarkersUpdate{});
  return unsent;
}

}  // namespace adit::gateway
