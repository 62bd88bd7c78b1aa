#include "api/reports_csv.hpp"

#include <gmock/gmock.h>

#include <limits>

namespace adit::api {
namespace {

std::string csv(const std::vector<facts::ReportRow>& rows) {
  std::string text = csv_header();
  for (const facts::ReportRow& row : rows) text += csv_line(row);
  return text;
}

using testing::HasSubstr;

constexpr const char* kHeader =
    "number,run,type,x,y,z,sender,received,changed,state,asking,reconciled,same_as,status,report_status,"
    "score_change,note,robot\r\n";

facts::ReportRow row() {
  return {.number = 7,
          .type = "Survivor",
          .position = icd::Point{85.75, -4.5, 0.25},
          .sender = "10.0.0.5",
          .robot = "spot1",
          .received = 1566309785.125,
          .changed = 1566309786,
          .state = "answered",
          .status = 201,
          .report_status = "scored",
          .score_change = 1,
          .note = {}};
}

std::string note_cell(std::string note) {
  facts::ReportRow noted;
  noted.note = std::move(note);
  const std::string text = csv({noted});
  const std::string before = std::string(kHeader) +
                             "0,1,,0,0,0,,1970-01-01T00:00:00.000Z,"
                             "1970-01-01T00:00:00.000Z,,no,no,,,,,";
  EXPECT_THAT(text, testing::StartsWith(before));
  EXPECT_THAT(text, testing::EndsWith(",\r\n"));
  return text.substr(before.size(), text.size() - before.size() - 3);
}

TEST(ReportsCsv, HasAHeaderAndALineForEachReport) {
  EXPECT_EQ(csv({}), kHeader);
  EXPECT_EQ(csv({row()}), std::string(kHeader) +
                              "7,1,Survivor,85.75,-4.5,0.25,10.0.0.5,2019-08-20T14:03:05.125Z,"
                              "2019-08-20T14:03:06.000Z,answered,no,no,,201,scored,1,,spot1\r\n");
}

TEST(ReportsCsv, HasNoPositionForALostReport) {
  facts::ReportRow lost = row();
  lost.position.reset();
  EXPECT_THAT(csv({lost}), HasSubstr("7,1,Survivor,,,,10.0.0.5,"));
}

TEST(ReportsCsv, ShowsReconciledAnswersZeroPointsAndRepeats) {
  facts::ReportRow settled = row();
  settled.state = "settled";
  settled.score_change = 0;
  settled.reconciled = true;
  settled.same_as = 3;
  EXPECT_THAT(csv({settled}), HasSubstr(",settled,no,yes,3,201,scored,0,"));
  settled.state = "in_doubt";
  settled.asking = true;
  EXPECT_THAT(csv({settled}), HasSubstr(",in_doubt,yes,yes,"));
}

TEST(ReportsCsv, QuotesCellsWithSeparators) {
  EXPECT_EQ(note_cell("a, b"), "\"a, b\"");
  EXPECT_EQ(note_cell("said \"no\""), "\"said \"\"no\"\"\"");
  EXPECT_EQ(note_cell("two\r\nlines\tand\x1b[2J"), "two  lines and [2J");
}

TEST(ReportsCsv, DefusesFormulas) {
  for (const std::string formula : {"=1+1", "+1", "-1", "@SUM(A1)", "  =1", "\uff1d1+1"}) {
    EXPECT_EQ(note_cell(formula), "'" + formula);
  }
  EXPECT_EQ(note_cell("\t=1"), "' =1");
  EXPECT_EQ(note_cell("=HYPERLINK(\"http://x\",1)"), "\"'=HYPERLINK(\"\"http://x\"\",1)\"");
  EXPECT_EQ(note_cell("1 = 1"), "1 = 1");
}

TEST(ReportsCsv, IsUtf8ForAnyText) {
  EXPECT_EQ(note_cell("caf\xc3\xa9"), "caf\xc3\xa9");
  EXPECT_EQ(note_cell("\xff\xc3(\xe2\x82"), "\xef\xbf\xbd\xef\xbf\xbd(\xef\xbf\xbd\xef\xbf\xbd");
  EXPECT_EQ(note_cell("a\xc2\x9b"
                      "2J"),
            "a 2J");
}

TEST(IsoTime, IsEmptyForNoTime) {
  EXPECT_EQ(iso_time(0), "1970-01-01T00:00:00.000Z");
  EXPECT_EQ(iso_time(253402300799.5), "9999-12-31T23:59:59.500Z");
  for (const double none : {-1.0, 253402300800.0, std::numeric_limits<double>::quiet_NaN(),
                            std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(iso_time(none), "");
  }
}

}  // namespace
}  // namespace adit::api
