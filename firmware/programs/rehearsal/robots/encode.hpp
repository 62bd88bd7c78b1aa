#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rehearsal/robots/http.hpp"
#include "rehearsal/robots/messages.hpp"

namespace adit::robots {

/// How a map's `data` is written.
enum class DataForm : std::uint8_t {
  Bytes,     // a CBOR byte string
  Base64,    // a JSON string
  Integers,  // a JSON array, -1 for unknown (grids alone; clouds are Base64 beside it)
};

/// One way in which teams' software speaks to a Command Post. All of them are in use in the field.
struct Style {
  std::string_view name;
  bool cbor = false;
  DataForm data = DataForm::Base64;
  bool gzip_data = false;  // "compression": "gzip"
  bool gzip_body = false;  // Content-Encoding: gzip
  bool ros = false;        // whole ROS dictionaries: seq, ROS's times, integers where floats are asked for,
                           // quaternions of all zeros and of length 2, rows with padding, maps without a name
  bool browser = false;    // a CORS preflight first, a charset, a trailing slash, `bearer`
};

inline constexpr std::array kStyles = {
    Style{.name = "cbor", .cbor = true, .data = DataForm::Bytes, .gzip_data = true},
    Style{.name = "cbor-body-gzip", .cbor = true, .data = DataForm::Bytes, .gzip_body = true},
    Style{.name = "json-base64", .gzip_data = true},
    Style{.name = "json-array", .data = DataForm::Integers},
    Style{.name = "ros", .data = DataForm::Integers, .ros = true},
    Style{.name = "browser", .browser = true},
    Style{.name = "cbor-plain", .cbor = true, .data = DataForm::Bytes},
};

/// What a team speaks: one style, or all in turn (`mixed`).
class TeamStyle {
 public:
  /// Mixed.
  TeamStyle() = default;

  /// Nothing where no style has that name.
  static std::optional<TeamStyle> parse(std::string_view name);

  const Style& of(std::size_t robot) const { return kStyles[one_.value_or(robot % kStyles.size())]; }

 private:
  explicit TeamStyle(std::size_t one) : one_(one) {}
  std::optional<std::size_t> one_;  // index in kStyles
};

/// One gzip member (RFC 1952).
std::vector<std::uint8_t> gzip(std::span<const std::uint8_t> bytes);

/// RFC 4648 section 4, padded.
std::string base64(std::span<const std::uint8_t> bytes);

/// Gives one robot's messages the bytes that clients of its style send. Independent of Adit's codec.
class Encoder {
 public:
  /// `style` outlives the encoder.
  Encoder(std::string robot, const Style& style, std::string token);

  HttpRequest encode(const Message& message);

  /// What a browser asks before it sends `request` (the Fetch standard's CORS preflight): no token, no body.
  static HttpRequest preflight(const HttpRequest& request);
  static constexpr const char* kOrigin = "http://operator-station.local";

 private:
  std::string robot_;
  const Style& style_;
  std::string token_;
  std::uint32_t seq_ = 0;  // of ROS headers
};

}  // namespace adit::robots
