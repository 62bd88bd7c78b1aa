#include "store/second_reader.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <limits>

namespace adit::store {
namespace {

struct FrameSeen {
  std::uint64_t file, offset, sequence, process, durable, base;
  int kind;
  std::string body;
  bool is_header() const { return kind == 0; }
};

std::uint32_t checksum(std::string_view bytes) {
  return static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

template <class Number>
Number at(std::string_view bytes, std::size_t place) {
  Number number{};
  std::memcpy(&number, bytes.data() + place, sizeof number);  // these machines are little-endian
  return number;
}

std::vector<FrameSeen> frames_of(std::uint64_t file, std::uint64_t salt, std::string_view bytes) {
  std::vector<FrameSeen> frames;
  for (std::size_t offset = 0; offset + 40 <= bytes.size(); offset += 8) {
    const std::string_view here = bytes.substr(offset);
    if (std::memcmp(here.data(), "ADTL", 4) != 0) continue;
    const auto length = at<std::uint32_t>(here, 8);
    if (length > here.size() - 40) continue;
    std::string summed(16, '\0');
    std::memcpy(summed.data(), &salt, 8);
    const std::uint64_t place = offset;
    std::memcpy(summed.data() + 8, &place, 8);
    summed += here.substr(8, 32 + length);
    if (checksum(summed) != at<std::uint32_t>(here, 4)) continue;
    const std::string body(here.substr(40, length));
    const int kind = static_cast<std::uint8_t>(here[12]);
    frames.push_back(
        {file, offset, at<std::uint64_t>(here, 16), at<std::uint64_t>(here, 24), at<std::uint64_t>(here, 32),
         kind == 0 ? at<std::uint64_t>(body, 24) : std::numeric_limits<std::uint64_t>::max(), kind, body});
  }
  return frames;
}

/// The bodies of a snapshot by number, if all of them are there.
std::optional<std::vector<std::string>> whole(const std::vector<FrameSeen>& frames) {
  std::map<std::uint64_t, const FrameSeen*> by_number;
  for (const FrameSeen& frame : frames) by_number[frame.sequence] = &frame;
  if (!by_number.contains(0) || by_number.rbegin()->second->kind != 127 ||
      by_number.rbegin()->first + 1 != by_number.size())
    return std::nullopt;
  std::vector<std::string> bodies;
  for (const auto& [number, frame] : by_number) {
    if (frame->kind != 0 && frame->kind != 127) bodies.push_back(frame->body);
  }
  return bodies;
}

}  // namespace

std::vector<std::string> SecondReading::bodies() const {
  std::vector<std::string> all = snapshot;
  for (const auto& [number, body] : records) all.push_back(body);
  return all;
}

SecondReading read_again(const std::map<std::string, std::string>& files) {
  SecondReading read;
  std::uint64_t begins = 0, base = 0, durable = 0;
  std::vector<FrameSeen> frames;
  for (const auto& [name, bytes] : files) {  // in order of numbers, because all names have the same length
    const auto point = name.find('.'), hyphen = name.find('-');
    if (point == name.npos || name.size() != point + 17 || name.starts_with("spare")) continue;
    const std::uint64_t number = std::stoull(name.substr(hyphen + 1, point - hyphen - 1));
    const std::vector<FrameSeen> its =
        frames_of(number, std::stoull(name.substr(point + 1), nullptr, 16), bytes);
    if (name.starts_with("log-")) {
      frames.insert(frames.end(), its.begin(), its.end());
    } else if (const auto bodies = whole(its)) {
      read.snapshot = *bodies;
      begins = number;
      base = durable = its.front().base;
    }
  }
  std::erase_if(frames, [begins](const FrameSeen& frame) { return frame.file < begins; });
  const std::vector<FrameSeen> all = frames;
  std::erase_if(frames, [&all](const FrameSeen& frame) {
    return std::ranges::any_of(all, [&frame](const FrameSeen& other) {
      const bool is_newer =
          other.file == frame.file && other.offset < frame.offset && other.process > frame.process;
      return is_newer || (other.is_header() && other.file > frame.file && frame.sequence > other.base);
    });
  });
  for (const FrameSeen& frame : frames) {
    durable = std::max({durable, frame.durable, frame.is_header() ? frame.base : 0});
    if (!frame.is_header() && frame.sequence > base) read.records.try_emplace(frame.sequence, frame.body);
  }
  for (std::uint64_t number = base + 1; number <= durable; ++number) {
    if (!read.records.contains(number)) read.missing.insert(number);
  }
  std::uint64_t end = durable + 1;
  while (read.records.contains(end)) ++end;
  read.records.erase(read.records.lower_bound(end), read.records.end());
  read.last = end - 1;
  return read;
}

}  // namespace adit::store
