#pragma once

#include <cstdint>
#include <expected>
#include <fstream>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "rehearsal/command_post/document.hpp"
#include "rehearsal/command_post/endpoint.hpp"

namespace adit::rehearsal {

/// A folder that a person can look through: requests.jsonl and reports.jsonl, one line each; grids/ and
/// clouds/ with a picture of each map. Safe for use by several threads.
class Transcript {
 public:
  /// Makes `folder`; lines go after those that a transcript there already has. Once `most` bytes are written
  /// there are no more pictures, only lines.
  static std::expected<std::unique_ptr<Transcript>, std::string> open(const std::string& folder,
                                                                      std::uint64_t most);

  /// How many requests are written down.
  std::uint64_t requests() const { return requests_; }

  /// Writes a request, and the picture of its map. Shortens `judgement.message`.
  void request(std::uint64_t number, const char* endpoint, const Request& request, Judgement& judgement);
  void report(const OrderedJson& line) { append(reports_file_, line); }

 private:
  Transcript(std::string folder, std::uint64_t most) : folder_(std::move(folder)), most_(most) {}
  /// Writes a map's picture, and returns its name within the folder ("grids/000012-X1.pgm"). std::nullopt if
  /// the budget is used up or the disk is full.
  std::optional<std::string> picture(std::uint64_t number, const MapMessage& map);
  void append(std::ofstream& file, const OrderedJson& line);

  const Clock::time_point opened_ = Clock::now();
  const std::string folder_;
  const std::uint64_t most_;
  std::uint64_t requests_ = 0;
  std::mutex mutex_;
  std::uint64_t written_ = 0;
  bool complained_ = false;
  std::ofstream requests_file_;
  std::ofstream reports_file_;
};

}  // namespace adit::rehearsal
