#include <gmock/gmock.h>

#include <string>
#include <utility>
#include <vector>

#include "forward/markers.hpp"
#include "host/folder.hpp"
#include "journal/left_in.hpp"
#include "loop/turn_until.hpp"

namespace adit::forward {
namespace {

using testing::ElementsAre;

icd::Marker change(std::int32_t id, std::string text, icd::MarkerAction action = icd::MarkerAction::Add) {
  icd::Marker marker;
  marker.header.stamp = 5;
  marker.ns = "ns";
  marker.id = id;
  marker.text = std::move(text);
  marker.action = action;
  return marker;
}

/// Too many for one turn of the loop.
icd::MarkersUpdate many(const std::string& text) {
  icd::MarkersUpdate update;
  for (std::int32_t id = 0; id < 2500; ++id) update.markers.push_back(change(id, text));
  return update;
}

class MarkerArrivalsTest : public testing::Test {
 protected:
  MarkerArrivalsTest() { journal_.begin({.boot = "b", .at = loop_.now(), .stamp = loop_.stamp_now()}); }

  void accept(icd::MarkersUpdate update) {
    arrivals_.accept(std::move(update), {.bytes = 10}, [this](const icd::Checked<void>& taken) {
      said_.push_back(taken ? icd::Status::Ok : taken.error().status);
    });
  }
  bool turn_until(auto done) { return loop::turn_until(loop_, done); }
  std::vector<icd::Marker> left() const {
    return journal::left_in(folder_.path() + "/journal").markers().markers;
  }

  host::Folder folder_;
  loop::Loop loop_;
  loop::Workers workers_{loop_, 1};
  journal::Journal journal_{loop_, folder_.path() + "/journal"};
  queues::MarkerQueue queue_{{}};
  TrafficCounts counts_{[] {}};
  std::vector<icd::Status> said_;
  MarkerArrivals arrivals_{loop_, workers_, journal_, queue_, counts_};
};

TEST_F(MarkerArrivalsTest, AreQueuedAtOnceIfTheyAreFew) {
  accept({{change(1, "a")}});
  EXPECT_THAT(said_, ElementsAre(icd::Status::Ok));
  EXPECT_TRUE(arrivals_.empty());
  EXPECT_EQ(queue_.pending(), left());
}

TEST_F(MarkerArrivalsTest, AreLeftOutIfNewerOnesOvertookThem) {
  const auto take_as = [&](icd::Marker marker, double stamp, queues::Upload upload) {
    marker.header.stamp = stamp;
    icd::MarkersUpdate update{.markers = {std::move(marker)}};
    arrivals_.accept(std::move(update), std::move(upload),
                     [](const icd::Checked<void>& taken) { EXPECT_TRUE(taken); });
  };
  take_as(change(1, "", icd::MarkerAction::Delete), 10, {.bytes = 10, .began = 2, .ended = 3, .overlaps = 1});
  take_as(change(1, "a"), 9, {.bytes = 10, .began = 1, .ended = 4});
  ASSERT_EQ(queue_.pending().size(), 1u);
  EXPECT_EQ(queue_.pending()[0].action, icd::MarkerAction::Delete);
  EXPECT_EQ(queue_.pending(), left());
  EXPECT_EQ(counts_.rows().at({TrafficKind::Markers, ""}).accepted, 2u);
}

TEST_F(MarkerArrivalsTest, AreCountedIfTheyAreInvisible) {  // ICD 6.6
  icd::MarkersUpdate update = many("a");
  for (icd::Marker& marker : update.markers) marker.color = {1, 0, 0, 1};
  update.markers[0].color.a = update.markers[2400].color.a = 0;
  update.markers[1].color.a = 0, update.markers[1].colors = {{1, 0, 0, 1}};
  update.markers[2].color.a = 0, update.markers[2].mesh_use_embedded_materials = true;
  update.markers[3].color.a = 0, update.markers[3].action = icd::MarkerAction::Delete;
  accept(std::move(update));
  ASSERT_TRUE(turn_until([this] { return !said_.empty(); }));
  EXPECT_THAT(said_, ElementsAre(icd::Status::Ok)) << "accepted";
  EXPECT_EQ(counts_.rows().at({TrafficKind::Markers, ""}).invisible, 2u);
}

TEST_F(MarkerArrivalsTest, AreAnsweredOnceAllAreStoredAndQueued) {
  accept(many("many"));
  EXPECT_THAT(said_, ElementsAre());
  ASSERT_TRUE(turn_until([this] { return left().size() == 2500; }));
  EXPECT_TRUE(arrivals_.is_in_part());
  EXPECT_EQ(queue_.count(), 0u) << "the journal is first";
  EXPECT_THAT(said_, ElementsAre());
  ASSERT_TRUE(turn_until([this] { return !said_.empty(); }));
  EXPECT_THAT(said_, ElementsAre(icd::Status::Ok));
  EXPECT_EQ(queue_.pending(), many("many").markers);
}

/// The journal has the same order.
TEST_F(MarkerArrivalsTest, KeepTheOrderOfAcceptance) {
  accept(many("older"));
  accept({{change(2499, "newer")}});
  accept({{change(7, "", icd::MarkerAction::Delete)}});
  ASSERT_TRUE(turn_until([this] { return said_.size() == 3; }));
  EXPECT_EQ(queue_.pending(), left());
  EXPECT_EQ(queue_.pending().at(2499).text, "newer");
  EXPECT_EQ(queue_.pending().at(7).action, icd::MarkerAction::Delete);
}

TEST_F(MarkerArrivalsTest, EndWithADeleteAll) {
  accept(many("older"));
  accept({{change(0, "wipe", icd::MarkerAction::DeleteAll), change(3, "newer")}});
  ASSERT_TRUE(turn_until([this] { return said_.size() == 2; }));
  EXPECT_EQ(queue_.count(), 2u);
  EXPECT_EQ(queue_.pending(), left());
}

/// One record would exceed store::kMostBody.
TEST_F(MarkerArrivalsTest, AreStoredUpToTheLimitOfAMessage) {
  icd::MarkersUpdate most;
  for (std::int32_t id = 0; id < 100'000; ++id)
    most.markers.push_back(change(id, "", icd::MarkerAction::Delete));
  accept(most);
  ASSERT_TRUE(turn_until([this] { return !said_.empty(); }));
  EXPECT_THAT(said_, ElementsAre(icd::Status::Ok));
  EXPECT_EQ(left(), most.markers);
}

TEST_F(MarkerArrivalsTest, AreRejectedAsAWholeByAFullQueue) {
  queue_.set_bounds({.bytes = 3000 * icd::bytes_of(change(0, "12345"))});
  accept(many("12345"));
  icd::MarkersUpdate others = many("12345");
  for (icd::Marker& marker : others.markers) marker.id += 10'000;
  accept(std::move(others));
  ASSERT_TRUE(turn_until([this] { return said_.size() == 2; }));
  EXPECT_THAT(said_, ElementsAre(icd::Status::Ok, icd::Status::TooManyRequests));
  EXPECT_EQ(queue_.count(), 2500u);
  EXPECT_EQ(left().size(), 2500u);
}

}  // namespace
}  // namespace adit::forward
