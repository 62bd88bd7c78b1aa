#pragma once

#include <cstdint>
#include <string>

#include "rehearsal/robots/http.hpp"
#include "rehearsal/robots/messages.hpp"
#include "rehearsal/robots/style.hpp"

namespace adit::robots {

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
