// A written message reads back equal, in Adit's own form and in each style of known clients.
#include <gtest/gtest.h>

#include <cmath>

#include "codec/messages.hpp"
#include "codec/read.hpp"
#include "codec/write.hpp"

namespace adit::codec {
namespace {

using test::Bytes;
using test::json;
using test::Random;

constexpr int kRounds = 40;
constexpr BodyKind kCborBody = {.format = Format::Cbor, .coding = ContentCoding::Identity};

template <class Message>
Message must(icd::Checked<Message> checked) {
  if (!checked) throw std::runtime_error(checked.error().sentence);  // GoogleTest reports it
  return *std::move(checked);
}

/// Decodes a body that arrives in pieces of any size.
Document arrive(BodyKind kind, Split split, std::string_view body, Random& random) {
  BodyDecoder decoder(kind, split, {});
  const std::size_t longest = body.size() < 2000 ? 20 : 50'000;
  while (!body.empty()) {
    const auto piece = body.substr(0, 1 + random() % longest);
    const auto fed = decoder.feed({reinterpret_cast<const std::uint8_t*>(piece.data()), piece.size()});
    if (!fed) throw std::runtime_error(fed.error().sentence);
    body.remove_prefix(piece.size());
  }
  return must(decoder.finish());
}

icd::MapUpdate map_of(BodyKind kind, std::string_view body, Random& random) {
  return must(read_map_update(arrive(kind, Split::MapData, body, random), {}));
}

TEST(RoundTrip, OfGrids) {
  Random random(1);
  for (int round = 0; round < kRounds; ++round) {
    const icd::MapUpdate map = test::random_grid(random);
    test::expect_same(map_of(kCborBody, write_map_update(map).to_string(), random), map);
  }
}

TEST(RoundTrip, OfClouds) {
  Random random(2);
  for (int round = 0; round < kRounds; ++round) {
    const icd::MapUpdate map = test::random_cloud(random);
    test::expect_same(map_of(kCborBody, write_map_update(map).to_string(), random), test::little_endian(map));
  }
}

TEST(RoundTrip, OfStates) {
  Random random(3);
  for (int round = 0; round < kRounds; ++round) {
    const icd::StateUpdate state = test::random_state(random);
    const std::string body = write_state_update(state).to_string();
    EXPECT_EQ(must(read_state_update(arrive(kCborBody, Split::Nothing, body, random), {})), state);
  }
}

TEST(RoundTrip, OfMarkers) {
  Random random(4);
  for (int round = 0; round < kRounds; ++round) {
    const icd::MarkersUpdate markers = test::random_markers(random);
    const std::string body = write_markers_update(markers).to_string();
    EXPECT_EQ(must(read_markers_update(arrive(kCborBody, Split::Nothing, body, random), {})), markers);
  }
}

/// The message that Adit writes for `map`, as a document with uncompressed data, for a client's style.
json as_document(const icd::MapUpdate& map) {
  json document = json::from_cbor(write_map_update(map).to_vector());
  document["msg"]["data"] = json::binary(test::raw_data(map.data));
  document["msg"].erase("compression");
  return document;
}

Bytes& data_of(json& document) {
  return document["msg"]["data"].get_binary();
}

void with_gzip(json& document) {
  document["msg"]["data"] = json::binary(test::compressed(data_of(document)));
  document["msg"]["compression"] = "gzip";
}

void as_integers(json& document) {
  json integers = json::array();
  for (const std::uint8_t cell : data_of(document)) integers.push_back(cell == 255 ? -1 : int{cell});
  document["msg"]["data"] = integers;
}

void with_everything_of_ros(json& document) {
  json& msg = document["msg"];
  msg["header"]["seq"] = 4711;
  msg["header"].erase("frame_id");
  if (msg["header"].contains("stamp"))
    msg["header"]["stamp"] = {{"secs", 1617235200}, {"nsecs", 500'000'000}};
  if (msg.contains("info")) msg["info"]["map_load_time"] = {{"secs", 0}, {"nsecs", 0}};
  for (const char* extra : {"height", "width", "row_step"}) msg[extra] = 1;
  msg["is_dense"] = true;
}

/// Writes whole numbers without a fraction, as JavaScript does.
void with_integers_for_floats(json& value) {
  if (value.is_number_float()) {
    const double number = value;
    if (std::trunc(number) == number && std::abs(number) < 1e15) value = static_cast<std::int64_t>(number);
  } else if (value.is_structured()) {
    for (auto& child : value) with_integers_for_floats(child);
  }
}

struct Style {
  const char* name;
  void (*put_on)(json&);
  bool for_clouds;
};

const Style kStyles[] = {
    {"as it is", [](json&) {}, true},
    {"gzip in the data", with_gzip, true},
    {"an array of integers", as_integers, false},
    {"a ROS dictionary", with_everything_of_ros, true},
    {"a ROS dictionary with an array of integers",
     [](json& document) {
       with_everything_of_ros(document);
       as_integers(document);
     },
     false},
    {"integers for floats", with_integers_for_floats, true},
    {"no name, no header where they say nothing",
     [](json& document) {
       if (document["name"] == "") document.erase("name");
       if (!document["msg"]["header"].contains("stamp")) document["msg"].erase("header");
     },
     true},
};

struct Coding {
  ContentCoding coding;
  int window;  // of zlib; 0: uncompressed
};

constexpr Coding kCodings[] = {{ContentCoding::Identity, 0},
                               {ContentCoding::Gzip, 31},
                               {ContentCoding::Deflate, 15},
                               {ContentCoding::Deflate, -15}};

std::string encoded(const std::string& body, const Coding& coding) {
  if (coding.window == 0) return body;
  const Bytes bytes = test::compressed(Bytes(body.begin(), body.end()), coding.window);
  return {bytes.begin(), bytes.end()};
}

TEST(RoundTrip, OfMapsInEachStyleOfClients) {
  Random random(7);
  for (int round = 0; round < 6; ++round) {
    for (const Style& style : kStyles) {
      const bool cloud = style.for_clouds && round % 2 == 0;
      icd::MapUpdate map = cloud ? test::random_cloud(random) : test::random_grid(random);
      json document = as_document(map);
      style.put_on(document);
      if (document["msg"].contains("is_dense") && map.header().stamp) map.header().stamp = 1617235200.5;
      for (const Coding& coding : kCodings) {
        SCOPED_TRACE(testing::Message() << style.name << ", coding " << coding.window);
        test::expect_same(
            map_of({Format::Json, coding.coding}, encoded(test::as_json(document), coding), random),
            test::little_endian(map));
        test::expect_same(
            map_of({Format::Cbor, coding.coding}, encoded(test::as_cbor(document), coding), random),
            test::little_endian(map));
      }
    }
  }
}

TEST(RoundTrip, OfStatesAndMarkersInJsonOfClients) {
  Random random(8);
  for (int round = 0; round < kRounds; ++round) {
    const icd::StateUpdate state = test::random_state(random);
    json state_document = json::from_cbor(write_state_update(state).to_vector());
    const icd::MarkersUpdate markers = test::random_markers(random);
    json markers_document = json::from_cbor(write_markers_update(markers).to_vector());
    if (round % 2 == 0) {
      with_integers_for_floats(state_document);
      with_integers_for_floats(markers_document);
    }
    for (const Coding& coding : kCodings) {
      const BodyKind kind = {Format::Json, coding.coding};
      const auto read_state = arrive(kind, Split::Nothing, encoded(state_document.dump(), coding), random);
      EXPECT_EQ(must(read_state_update(read_state, {})), state);
      const auto read_markers =
          arrive(kind, Split::Nothing, encoded(markers_document.dump(), coding), random);
      EXPECT_EQ(must(read_markers_update(read_markers, {})), markers);
    }
  }
}

/// Damaged bodies are rejected or read, and never crash. A body that is read can be written and read again.
TEST(RoundTrip, SurvivesDamagedBodies) {
  Random random(9);
  int accepted = 0;
  for (int round = 0; round < 400; ++round) {
    const json good = round % 2 == 0 ? test::good_grid() : test::good_cloud();
    const auto format = round % 4 < 2 ? Format::Json : Format::Cbor;
    std::string body = format == Format::Json ? test::as_json(good) : test::as_cbor(good);
    body[random() % body.size()] = static_cast<char>(random());
    auto document = decode({.format = format}, Split::MapData, body);
    if (!document) continue;
    const auto map = read_map_update(std::move(*document), {});
    if (!map) {
      EXPECT_FALSE(map.error().sentence.empty());
      continue;
    }
    ++accepted;
    test::expect_same(map_of(kCborBody, write_map_update(*map).to_string(), random), *map);
  }
  EXPECT_GT(accepted, 10);
}

}  // namespace
}  // namespace adit::codec
