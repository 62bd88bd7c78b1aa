#include "gateway/spool.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>

#include "codec/body_decoder.hpp"
#include "codec/read.hpp"
#include "codec/write.hpp"
#include "host/log.hpp"

namespace adit::gateway {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kState = "/state.cbor", kMarkers = "/markers.cbor";
constexpr std::string_view kMap = "map-", kEnding = ".cbor", kPart = ".part";

/// The number in "map-00000012.cbor"; nothing for another file.
std::optional<std::uint64_t> number_in(std::string_view name) {
  if (!name.starts_with(kMap) || !name.ends_with(kEnding)) return std::nullopt;
  name.remove_prefix(kMap.size());
  name.remove_suffix(kEnding.size());
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error != std::errc() || end != name.data() + name.size()) return std::nullopt;
  return number;
}

void write(const std::string& path, const icd::ChunkedBytes& bytes) {
  const std::string part = path + std::string(kPart);
  std::ofstream file(part, std::ios::binary);
  for (const auto& chunk : bytes.chunks()) {
    file.write(reinterpret_cast<const char*>(chunk->data()), static_cast<std::streamsize>(chunk->size()));
  }
  file.close();
  std::error_code error;
  if (file) fs::rename(part, path, error);
  if (file && !error) return;
  fs::remove(part, error);
  host::log(host::Level::Warning, "a waiting message is kept in memory alone", {{"file", path}});
}

icd::Checked<codec::Document> decode(const std::string& path, codec::Split split, const icd::Rules& rules) {
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

/// The message in one file, which is set aside where it cannot be understood.
template <class Message, class Reader>
std::optional<Message> read_file(const std::string& path, codec::Split split, const icd::Rules& rules,
                                 const Reader& reader) {
  std::error_code error;
  if (!fs::exists(path, error)) return std::nullopt;
  auto document = decode(path, split, rules);
  icd::Checked<Message> message = document ? reader(std::move(*document), rules)
                                           : icd::Checked<Message>(std::unexpected(document.error()));
  if (message) return std::move(*message);
  host::log(host::Level::Error, "a kept message could not be read and is set aside",
            {{"file", path}, {"why", message.error().sentence}});
  fs::rename(path, path + ".damaged", error);
  return std::nullopt;
}

}  // namespace

Spool::Spool(std::string folder) : folder_(std::move(folder)) {
  std::error_code error;
  fs::create_directories(folder_, error);
  fs::permissions(folder_, fs::perms::owner_all, error);
}

std::string Spool::file_of(std::uint64_t number) const {
  std::array<char, 24> digits{};
  std::snprintf(digits.data(), digits.size(), "%08llu", static_cast<unsigned long long>(number));
  return folder_ + "/" + std::string(kMap) + digits.data() + std::string(kEnding);
}

void Spool::keep(std::uint64_t number, const icd::MapUpdate& map) const {
  write(file_of(number), codec::write_map_update(map));
}

void Spool::forget(std::uint64_t number) const {
  std::error_code error;
  fs::remove(file_of(number), error);
}

void Spool::keep(const icd::StateUpdate& state, const icd::MarkersUpdate& markers) const {
  std::error_code error;
  const std::string state_file = folder_ + std::string(kState),
                    markers_file = folder_ + std::string(kMarkers);
  state.poses.empty() ? void(fs::remove(state_file, error))
                      : write(state_file, codec::write_state_update(state));
  markers.markers.empty() ? void(fs::remove(markers_file, error))
                          : write(markers_file, codec::write_markers_update(markers));
}

Spool::Kept Spool::read(const icd::Rules& rules) const {
  std::vector<std::uint64_t> numbers;
  std::error_code error;
  for (const auto& file : fs::directory_iterator(folder_, error)) {
    if (const auto number = number_in(file.path().filename().string())) numbers.push_back(*number);
    if (file.path().extension() == kPart) fs::remove(file.path(), error);  // a kill came while it was written
  }
  std::ranges::sort(numbers);
  Kept kept;
  for (const std::uint64_t number : numbers) {
    auto map =
        read_file<icd::MapUpdate>(file_of(number), codec::Split::MapData, rules, codec::read_map_update);
    if (map) kept.maps.emplace_back(number, std::move(*map));
  }
  kept.state = read_file<icd::StateUpdate>(folder_ + std::string(kState), codec::Split::Nothing, rules,
                                           codec::read_state_update)
                   .value_or(icd::StateUpdate{});
  kept.markers = read_file<icd::MarkersUpdate>(folder_ + std::string(kMarkers), codec::Split::Nothing, rules,
                                               codec::read_markers_update)
                     .value_or(icd::MarkersUpdate{});
  return kept;
}

}  // namespace adit::gateway
