#include "api/map_routes.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "api/map_scene.hpp"
#include "api/on_page.hpp"
#include "intake/raw_client.hpp"
#include "intake/served.hpp"
#include "picture/palette.hpp"

namespace adit::api {
namespace {

using nlohmann::json;
using testing::StartsWith;

/// The scene, drawn once, because drawing takes longer than the tests.
const picture::Mosaic& drawn_scene() {
  static const picture::Mosaic drawn = [] {
    picture::Mosaic map;
    draw_scene(map, 2000);
    return map;
  }();
  return drawn;
}

class MapRoutesTest : public OnPage {
 protected:
  void SetUp() override { source.mosaic = drawn_scene(); }
};

TEST_F(MapRoutesTest, DescribesTilesAndColours) {
  const json map = json::parse(get_file("/adit/map").body);
  EXPECT_EQ(map["version"], source.mosaic.version());
  EXPECT_EQ(map["tile_side"], 256);
  EXPECT_EQ(map["metres_per_pixel"], (json{0.25, 1.0, 4.0}));
  EXPECT_EQ(map["colours"]["free"], "#c8d2da");
  EXPECT_EQ(map["colours"]["occupied"], "#a8321e");
  EXPECT_EQ(map["colours"]["heights"].size(), picture::height_ramp().size());
  EXPECT_EQ(map["spacing"], 1.0);
  EXPECT_TRUE(map["wiped"].is_null());
}

TEST_F(MapRoutesTest, ShowsTheAreaCoveredByGrids) {
  const json covered = json::parse(get_file("/adit/covered").body);
  picture::CoveredArea area;
  area.update(area.changes(source.mosaic));
  EXPECT_EQ(covered["version"], source.mosaic.version());
  EXPECT_EQ(covered["square_metres"], static_cast<double>(area.now().all) / 16);
  EXPECT_GT(covered["square_metres"], 100.0);
  EXPECT_EQ(covered["whole"], true);
  ASSERT_EQ(covered["robots"].size(), 1) << "ugv1 has only a cloud";
  EXPECT_EQ(covered["robots"][0]["robot"], "");
  EXPECT_EQ(covered["robots"][0]["square_metres"], covered["square_metres"]);
}

TEST_F(MapRoutesTest, ListsLayersAndTheirTiles) {
  const json layers = json::parse(get_file("/adit/map").body)["layers"];
  ASSERT_EQ(layers.size(), 2);
  EXPECT_EQ(layers[0]["robot"], "");
  EXPECT_EQ(layers[0]["kind"], "grid");
  EXPECT_TRUE(layers[0]["heights"].is_null());
  EXPECT_EQ(layers[0]["first"], 1429.0);
  EXPECT_EQ(layers[0]["last"], 1999.0);
  EXPECT_EQ(layers[0]["missed"], 0);
  EXPECT_EQ(layers[0]["left_out"], 0);
  EXPECT_LT(layers[0]["bounds"]["left"], layers[0]["bounds"]["right"]);
  EXPECT_LT(layers[0]["bounds"]["bottom"], layers[0]["bounds"]["top"]);
  EXPECT_EQ(layers[1]["robot"], "ugv1");
  EXPECT_EQ(layers[1]["kind"], "cloud");
  EXPECT_LT(layers[1]["heights"]["low"], layers[1]["heights"]["high"]);
  for (const json& tile : layers[0]["tiles"]) {
    EXPECT_GE(tile["first"], 1429.0);
    EXPECT_LE(tile["first"], tile["stamp"]);
    EXPECT_EQ(tile["blank"], false);
    EXPECT_LE(tile["version"], source.mosaic.version());
  }
}

TEST_F(MapRoutesTest, ServesEachListedTile) {
  const json map = json::parse(get_file("/adit/map").body);
  for (const json& layer : map["layers"]) {
    ASSERT_FALSE(layer["tiles"].empty());
    const std::string robot = layer["robot"].get<std::string>();
    for (const json& tile : layer["tiles"]) {
      const std::string path = "/adit/map/" + layer["kind"].get<std::string>() + "/" +
                               (robot.empty() ? "-" : robot) + "/" + tile["level"].dump() + "/" +
                               tile["x"].dump() + "/" + tile["y"].dump() + ".png";
      const auto answer = get_file(path);
      ASSERT_EQ(answer.status, icd::Status::Ok) << path;
      EXPECT_EQ(answer.content_type, "image/png");
      EXPECT_THAT(answer.body, StartsWith("\x89PNG\r\n"));
      EXPECT_EQ(get_file(path + "?at=" + tile["first"].dump()).status, icd::Status::Ok) << path;
      EXPECT_EQ(get_file(path + "?at=1000").status, icd::Status::NotFound) << "before anything was drawn";
    }
  }
}

TEST_F(MapRoutesTest, ServesSeveralTilesInOneAnswer) {
  const json layer = json::parse(get_file("/adit/map").body)["layers"][0];
  std::string places = "0/9999/9999", images;
  for (const json& tile : layer["tiles"]) {
    const std::string place = tile["level"].dump() + "/" + tile["x"].dump() + "/" + tile["y"].dump();
    places += "," + place;
    images += get_file("/adit/map/grid/-/" + place + ".png?from=0a0b0c&to=F0E0D0").body;
  }
  const std::string path = "/adit/map/grid/-/tiles?from=0a0b0c&to=F0E0D0&tiles=" + places;
  const auto answer = get_file(path);
  ASSERT_EQ(answer.status, icd::Status::Ok) << answer.body;
  const std::size_t end = answer.body.find('\n');
  EXPECT_EQ(answer.body.substr(end + 1), images);
  const json heads = json::parse(answer.body.substr(0, end))["tiles"];
  ASSERT_EQ(heads.size(), layer["tiles"].size() + 1);
  EXPECT_EQ(heads[0], (json{{"place", "0/9999/9999"}, {"bytes", 0}, {"since", nullptr}, {"until", nullptr}}));
  EXPECT_EQ(heads[1]["since"], layer["tiles"][0]["stamp"]);
  const auto before = get_file(path + "&at=1000");
  EXPECT_EQ(before.body.find('\n') + 1, before.body.size()) << "before anything was drawn";
}

TEST_F(MapRoutesTest, RefusesWrongListsOfTiles) {
  std::string most = "0/0/0";
  for (int i = 1; i < 64; ++i) most += ",0/" + std::to_string(i) + "/0";
  EXPECT_EQ(get_file("/adit/map/grid/-/tiles?tiles=" + most).status, icd::Status::Ok);
  for (const std::string& tiles : {std::string(), most + ",0/64/0", std::string("0/0"),
                                   std::string("0/0/0/0"), std::string("a/0/0"), std::string("-1/0/0")}) {
    EXPECT_EQ(get_file("/adit/map/grid/-/tiles?tiles=" + tiles).status, icd::Status::BadRequest) << tiles;
  }
  EXPECT_EQ(get_file("/adit/map/shape/-/tiles?tiles=0/0/0").status, icd::Status::NotFound);
}

TEST_F(MapRoutesTest, ListsOnlyTilesChangedSince) {
  const auto before = source.mosaic.version();
  const json same = json::parse(get_file("/adit/map?since=" + std::to_string(before)).body);
  EXPECT_TRUE(same["layers"][0]["tiles"].empty());
  source.mosaic.wipe(3000);
  const json wiped = json::parse(get_file("/adit/map?since=" + std::to_string(before)).body);
  EXPECT_EQ(wiped["wiped"], 3000.0);
  EXPECT_TRUE(wiped["layers"][0]["bounds"].is_null());
  ASSERT_FALSE(wiped["layers"][0]["tiles"].empty());
  EXPECT_EQ(wiped["layers"][0]["tiles"][0]["blank"], true);
}

TEST_F(MapRoutesTest, SendsATileAgainOnlyIfItChanged) {
  const auto first = get_file("/adit/map/grid/-/1/0/0.png");
  ASSERT_EQ(first.status, icd::Status::Ok);
  EXPECT_EQ(header(first, "Cache-Control"), "no-cache");
  const auto again = get_file("/adit/map/grid/-/1/0/0.png", header(first, "ETag"));
  EXPECT_EQ(static_cast<int>(again.status), 304);
  EXPECT_EQ(again.body, "");
  const auto earlier = get_file("/adit/map/grid/-/1/0/0.png?at=1700", header(first, "ETag"));
  EXPECT_EQ(earlier.status, icd::Status::Ok);
  EXPECT_NE(earlier.body, first.body);
  EXPECT_EQ(header(earlier, "Cache-Control"), "max-age=3600") << "a later picture exists";
  EXPECT_LE(std::stod(header(earlier, "Adit-Since")), 1700);
  EXPECT_GT(std::stod(header(earlier, "Adit-Until")), 1700);
  EXPECT_EQ(header(first, "Adit-Until"), "") << "no later picture exists";
  const auto until = header(earlier, "Adit-Until");
  EXPECT_EQ(header(get_file("/adit/map/grid/-/1/0/0.png?at=" + until), "Adit-Since"), until);
}

TEST_F(MapRoutesTest, SpreadsTheRequestedHeightsOverTheColours) {
  const auto usual = get_file("/adit/map/cloud/ugv1/0/0/0.png");
  const auto spread = get_file("/adit/map/cloud/ugv1/0/0/0.png?low=-1&high=7");
  ASSERT_EQ(spread.status, icd::Status::Ok);
  EXPECT_NE(spread.body, usual.body);
  EXPECT_EQ(spread.body.substr(900), usual.body.substr(900)) << "only the palette differs";
}

TEST_F(MapRoutesTest, ColoursATileAsRequested) {
  for (const std::string tile : {"/adit/map/grid/-/0/0/0.png", "/adit/map/cloud/ugv1/0/0/0.png"}) {
    const auto usual = get_file(tile), own = get_file(tile + "?from=0a0b0c&to=F0E0D0");
    ASSERT_EQ(own.status, icd::Status::Ok) << tile;
    EXPECT_THAT(own.body, testing::HasSubstr(std::string("\xf0\xe0\xd0", 3)));
    EXPECT_THAT(usual.body, testing::Not(testing::HasSubstr(std::string("\xf0\xe0\xd0", 3))));
    EXPECT_EQ(own.body.substr(own.body.find("IDAT")), usual.body.substr(usual.body.find("IDAT")));
  }
}

TEST_F(MapRoutesTest, RejectsUnknownTiles) {
  for (const char* path :
       {"/adit/map/", "/adit/map/grid", "/adit/map/grid/-/0/0/0", "/adit/map/grid/-/0/0/0.jpg",
        "/adit/map/state/-/0/0/0.png", "/adit/map/grid/-/0/0/0/0.png", "/adit/map/grid/-/0/0/.png",
        "/adit/map/grid/-/9/0/0.png", "/adit/map/grid/-/0/99999999999/0.png",
        "/adit/map/grid/nobody/0/0/0.png", "/adit/map/cloud/-/0/0/0.png", "/adit/map/grid/-/0/50/50.png",
        "/adit/map/grid//0/0/0.png", "/adit/maps"}) {
    const auto answer = get_file(path);
    EXPECT_EQ(answer.status, icd::Status::NotFound) << path;
    EXPECT_TRUE(json::parse(answer.body).is_string()) << path;
  }
}

TEST_F(MapRoutesTest, RejectsInvalidNumbers) {
  for (const char* target :
       {"/adit/map?since=x", "/adit/map?since=-1", "/adit/map?since=1.5", "/adit/map/grid/-/0/0/0.png?at=now",
        "/adit/map/grid/-/0/0/0.png?at=nan", "/adit/map/cloud/ugv1/0/0/0.png?low=inf",
        "/adit/map/cloud/ugv1/0/0/0.png?high=1e999", "/adit/map/grid/-/0/0/0.png?from=12345&to=123456",
        "/adit/map/grid/-/0/0/0.png?from=12345g&to=123456", "/adit/map/grid/-/0/0/0.png?from=123456",
        "/adit/map/grid/-/0/0/0.png?to=-12345&from=123456"}) {
    EXPECT_EQ(get_file(target).status, icd::Status::BadRequest) << target;
  }
}

TEST_F(MapRoutesTest, AnswersHeadLikeGet) {
  for (const char* path : {"/adit/map", "/adit/map/grid/-/0/0/0.png"}) {
    EXPECT_EQ(get_file(path, "", "HEAD").status, icd::Status::Ok);
  }
}

TEST_F(MapRoutesTest, ForbidsForeignContent) {
  for (const char* path : {"/adit/map", "/adit/map/grid/-/0/0/0.png", "/adit/map/nothing"}) {
    EXPECT_THAT(header(get_file(path), "Content-Security-Policy"), StartsWith("default-src 'none'")) << path;
  }
}

constexpr const char* kAuthorized = "Authorization: Bearer team-1\r\n";

TEST(MapRoutesOnAServer, ReadsTheQueryOfARealRequest) {
  std::unique_ptr<Api> api;
  Forward forward;
  intake::Served served{forward};
  Doubles doubles;
  doubles.source.mosaic = drawn_scene();
  served.on_loop([&] {
    api = std::make_unique<Api>(served.loop(), doubles.served(), std::vector{token()});
    forward.to = api.get();
  });
  intake::RawClient client{served.port()};
  client.send(intake::request("GET", "/adit/map/cloud/ugv1/0/0/0.png?low=-1&high=7&at=1999.5", kAuthorized));
  const auto reply = client.reply();
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->status, 200);
  EXPECT_THAT(reply->body, StartsWith("\x89PNG"));
  client.send(intake::request("GET", "/adit/map/grid/-/0/0/0.png?at=5", kAuthorized));
  const auto none = client.reply();
  ASSERT_TRUE(none);
  EXPECT_EQ(none->status, 404);
  served.on_loop([&] { forward.to = nullptr, api.reset(); });
}

}  // namespace
}  // namespace adit::api
