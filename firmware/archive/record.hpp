#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace adit::archive {

/// What a record tells. The numbers are in files: they stay.
enum class Kind : std::uint8_t {
  Head = 1,       // of each file: whose run it is of, and how tiles are cut
  Tile = 2,       // a state of a tile
  Layer = 3,      // what is known of a layer beside its tiles
  Wiped = 4,      // the picture was blank then
  Poses = 5,      // of one robot
  Sample = 6,     // of the plots
  Attention = 7,  // something that needs the operator came, or went
  Moved = 8,      // the time of day was set: all that such files told before is of so many seconds later
};

/// The largest that is written: a tile that nothing makes smaller.
inline constexpr std::size_t kLargestRecord = std::size_t{72} << 10;

/// A record as it stands in a file: four bytes that begin each, its length and its CRC-32 (RFC 1952 8), 4
/// bytes each and little-endian, its kind, and what it says.
std::string framed(Kind kind, std::string_view said);

/// Tells the whole records in `bytes`, in order. What is damaged is passed over up to the next whole record;
/// in a file that is damaged all over, the rest is. Returns the number of damaged records: not of torn ones,
/// which a death leaves.
std::size_t for_each_record(std::string_view bytes, const std::function<void(Kind, std::string_view)>& told);

}  // namespace adit::archive
