// The schemas of the rows in schemas.json, which a build describes the API with, are those that the rows'
// descriptions give.
#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "api/box.hpp"
#include "api/map_json.hpp"
#include "api/run_view.hpp"
#include "api/self_test.hpp"
#include "api/updates.hpp"

namespace adit::api {
namespace {

using nlohmann::json;

TEST(Schemas, AreAsTheDescriptionsOfTheRowsSay) {
  codec::Schemas made;
  for (const codec::Row* const row :
       {&RunView::kRow, &ReportDetail::kRow, &MarkerChanges::kRow, &Tracks::kRow, &MapView::kRow,
        &LogRecord::kRow, &UpdateView::kRow, &TestView::kRow, &About::kRow}) {
    made.of(*row);
  }
  const json rows = json::parse(codec::write_json({made.all()}));
  EXPECT_EQ(rows.size(), 21u);
  std::ifstream file(ADIT_SOURCE_DIR "/firmware/api/schemas.json");
  const json written = json::parse(file);
  for (const auto& [name, schema] : rows.items()) {
    EXPECT_EQ(written.value(name, json()), schema) << "of " << name << ", schemas.json should say:\n"
                                                   << schema;
  }
}

}  // namespace
}  // namespace adit::api
