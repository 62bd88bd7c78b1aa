#pragma once

#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "rehearsal/command_post/fields.hpp"
#include "rehearsal/command_post/gate.hpp"
#include "rehearsal/command_post/geometry.hpp"
#include "rehearsal/command_post/judgement.hpp"

namespace adit::rehearsal {

/// ICD 6.2: the stamps of a URI never run backward, within a message and from one to the next; equal ones are
/// fine. Safe for use by several threads.
class StampOrder {
 public:
  /// Writes down the first stamp that is before one that came earlier. A message that passes, or that is
  /// taken all the same (`taken_anyhow`), counts from then on.
  void check(const std::string& uri, const std::vector<Stamp>& stamps, bool taken_anyhow, Findings& findings);

 private:
  std::mutex mutex_;
  std::map<std::string, double> latest_;
};

/// The mapping endpoint of the ICD's section 6, to the letter. At most `hz` requests a second for each URI.
class StrictMapping : public Endpoint {
 public:
  StrictMapping(std::string token, double hz, Counted counted)
      : token_(std::move(token)), hz_(hz), counted_(counted) {}
  Judgement judge(const Request& request) override;

 private:
  bool too_many(const std::string& uri, const Request& request);
  void count(const std::string& uri, const Request& request);
  void judge_body(const Request& request, Judgement& judgement);

  const std::string token_;
  const double hz_;
  const Counted counted_;
  StampOrder stamps_;
  std::mutex mutex_;
  std::map<std::string, RateLimit> limits_;
};

/// The public test server for mapping, as measured: see each rule in its source. At most `hz` clouds a
/// second, of all robots together.
class MeasuredMapping : public Endpoint {
 public:
  MeasuredMapping(std::string token, double hz, Counted counted)
      : token_(std::move(token)), cloud_limit_(hz, counted) {}
  Judgement judge(const Request& request) override;

 private:
  void judge_body(const Request& request, Judgement& judgement);
  bool cloud_too_soon(const Request& request);

  const std::string token_;
  StampOrder stamps_;
  std::mutex mutex_;
  RateLimit cloud_limit_;
};

/// Said where a message could not be read and no finding tells why.
inline constexpr const char* kUnreadable = "The message could not be read";

/// A body for one of the mapping URIs, read.
struct MappingMessage {
  std::vector<Stamp> stamps;
  std::vector<Accepted> parts;
  std::optional<MapMessage> map;
  std::vector<MarkerChange> markers;
};

/// Reads the body of `judgement.uri` and writes down what is found. Leaves the document in judgement.message,
/// a map's data in it described, not kept. Nothing where there is no message.
std::optional<MappingMessage> read_mapping(const std::string& body, Format format, Judgement& judgement);

}  // namespace adit::rehearsal
