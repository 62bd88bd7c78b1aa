// Tokens, robots' names, URIs, artifact types: the ICD's small words.
#include <gtest/gtest.h>

#include <ostream>
#include <string>

#include "icd/bearer_token.hpp"
#include "icd/mapping.hpp"
#include "icd/robot_name.hpp"
#include "icd/scoring.hpp"
#include "icd/sentence.hpp"
#include "icd/uri.hpp"

namespace adit::icd {
namespace {

template <class T>
concept Streamable = requires(std::ostream& out, const T& value) { out << value; };
static_assert(Streamable<std::string>);
static_assert(!Streamable<BearerToken>, "a token must not be printed");
static_assert(!std::is_convertible_v<BearerToken, std::string>);
static_assert(!std::is_convertible_v<BearerToken, std::string_view>);

TEST(BearerToken, IsAnyVisibleAscii) {
  const auto token = BearerToken::parse("flux230{showroom");  // ICD 4
  ASSERT_TRUE(token.has_value());
  EXPECT_EQ(token->reveal(), "flux230{showroom");
  EXPECT_TRUE(BearerToken::parse("!~").has_value());
  EXPECT_TRUE(BearerToken::parse(std::string(256, 'a')).has_value());
}

TEST(BearerToken, RejectsBytesThatAHeaderCannotHold) {
  for (const std::string text : {"", "a b", "a\n", "a\r\nX: y", "\x7f", "h\xc3\xa9", " a"}) {
    EXPECT_FALSE(BearerToken::parse(text).has_value()) << testing::PrintToString(text);
  }
  EXPECT_FALSE(BearerToken::parse(std::string("a\0b", 3)).has_value());
  EXPECT_FALSE(BearerToken::parse(std::string(257, 'a')).has_value());
}

TEST(BearerToken, IsRedactedInForeignText) {
  std::string text = "got \"team-7\", team-7team-7 and Team-7";
  BearerToken::parse("team-7")->strike_from(text);
  EXPECT_EQ(text, "got \"[token]\", [token][token] and Team-7");
  BearerToken::parse("tok")->strike_from(text);
  EXPECT_EQ(text, "got \"[token]\", [token][token] and Team-7") << "too short to be a secret";
}

TEST(BearerToken, IsRedactedInEachEncoding) {
  const auto token = *BearerToken::parse(R"(flux230{"show\room<&)");
  std::string text =
      R"(flux230{"show\room<& flux230{\"show\\room<& flux230{""show\room<& flux230{\\\"show\\\\room<& )" +
      escape_html(token.reveal());
  token.strike_from(text);
  EXPECT_EQ(text, "[token] [token] [token] [token] [token]");
}

TEST(Redaction, RedactsHtmlTextButNotMarkup) {
  const auto token = *BearerToken::parse("a<b>&'c\"d");
  const Redaction redaction({token, *BearerToken::parse("table")});
  std::string text = "<table><td>" + escape_html("sent " + token.reveal()) + "</td></table>";
  redaction.strike_from_html(text);
  EXPECT_EQ(text, "<table><td>sent [token]</td></table>");
}

TEST(BearerToken, IsRedactedIfTruncated) {
  const std::string whole(64, 'k');
  const auto token = *BearerToken::parse("0123456789" + whole);
  std::string text = "type: expected one of ICD 3, got " + quote_text("0123456789" + whole);
  token.strike_from(text);
  EXPECT_EQ(text, "type: expected one of ICD 3, got \"[token]...\"");
  text = "0123456789 and 0123456789kk are something else";
  token.strike_from(text);
  EXPECT_EQ(text, "0123456789 and 0123456789kk are something else");
}

TEST(Redaction, RedactsJsonStringsAndKeepsItJson) {
  const Redaction redaction({*BearerToken::parse("12345678"), *BearerToken::parse("number\"s"),
                             *BearerToken::parse("numbers_"), *BearerToken::parse("grid")});
  std::string text = R"({"numbers_":12345678,"ns":"a12345678","kind":"grid","c":["number\"s","numbers_"]})";
  redaction.strike_from_strings(text);
  EXPECT_EQ(text, R"({"numbers_":12345678,"ns":"a[token]","kind":"grid","c":["[token]","[token]"]})");
  for (const std::string other : {"", "\"", "\"12345678", "\"12345678\\"}) {
    text = other;
    redaction.strike_from_strings(text);
    EXPECT_EQ(text.find("12345678"), std::string::npos) << other;
  }
}

TEST(BearerToken, MatchesOnlyItself) {
  const auto token = BearerToken::parse("abcabc");
  ASSERT_TRUE(token.has_value());
  EXPECT_TRUE(token->matches("abcabc"));
  for (const std::string text : {"", "abc", "abcab", "abcabd", "bbcabc", "abcabcabc", "ABCABC", "abcabc "}) {
    EXPECT_FALSE(token->matches(text)) << text;
  }
}

TEST(TokenIn, AcceptsTheSchemeInAnyCase) {
  EXPECT_EQ(token_in("Bearer flux230{showroom"), "flux230{showroom");
  EXPECT_EQ(token_in("bearer abc"), "abc");
  EXPECT_EQ(token_in("BEARER   abc  "), "abc");
  EXPECT_EQ(token_in(" \tBearer\tabc"), "abc");
}

TEST(TokenIn, IsEmptyWithoutAToken) {
  for (const std::string text :
       {"", "Bearer", "Bearer ", "  ", "Basic abc", "Bearerabc", "abc", "\"earer abc"}) {
    EXPECT_EQ(token_in(text), "") << text;
  }
}

TEST(RobotName, IsOneToTenLettersDigitsAndUnderscores) {
  for (const std::string text : {"a", "Z", "0", "_", "husky_01", "ABCDEFGHIJ"}) {
    const auto name = RobotName::parse(text);
    ASSERT_TRUE(name.has_value()) << text;
    EXPECT_EQ(name->text(), text);
  }
}

TEST(RobotName, RejectsOtherNames) {
  for (const std::string text : {"", "ABCDEFGHIJK", "a b", "a-b", "h\xc3\xbcsky", "a.b", "a/b", "a\n"}) {
    EXPECT_FALSE(RobotName::parse(text).has_value()) << testing::PrintToString(text);
  }
  EXPECT_FALSE(RobotName::parse(std::string("a\0", 2)).has_value());
}

TEST(UriOf, KnowsFivePathsWithAndWithoutASlash) {
  for (const Uri uri : kUris) {
    const std::string path(path_of(uri));
    EXPECT_EQ(uri_of(path), uri);
    EXPECT_EQ(uri_of(path + "/"), uri);
    EXPECT_EQ(method_of(uri), uri == Uri::Status ? "GET" : "POST");
  }
  EXPECT_EQ(path_of(Uri::ArtifactReports), "/api/artifact_reports");  // ICD 5.2
}

TEST(UriOf, RejectsOtherPaths) {
  for (const std::string path : {"", "/", "/api", "/api/status/x", "/API/status", "api/status",
                                 "/map/update2", "//map/update", "/map//update"}) {
    EXPECT_FALSE(uri_of(path).has_value()) << path;
  }
}

TEST(ArtifactType, IsFoundInAnyCaseAndGivenAsInTheIcd) {
  for (const std::string_view type : kArtifactTypes) {
    std::string upper(type);
    std::string lower(type);
    for (char& c : upper) c = static_cast<char>(std::toupper(c));
    for (char& c : lower) c = static_cast<char>(std::tolower(c));
    EXPECT_EQ(artifact_type(type), type);
    EXPECT_EQ(artifact_type(upper), type);
    EXPECT_EQ(artifact_type(lower), type);
  }
}

TEST(ArtifactType, IsEmptyForAnyOther) {
  for (const std::string text : {"", "test", "Cell", "Cell  Phone", "CellPhone", "Rope ", "Cubes", "Cub"}) {
    EXPECT_EQ(artifact_type(text), "") << text;
  }
}

TEST(Datatype, HasTheSizeOfTheIcdsTable) {  // ICD 6.3.2
  const std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  for (int code = 1; code <= 8; ++code) {
    EXPECT_EQ(size_of(static_cast<Datatype>(code)), sizes[code - 1]) << code;
  }
}

TEST(MapUpdate, HasTheHeaderOfItsMessage) {
  MapUpdate update{.name = {}, .msg = OccupancyGrid{}, .data = {}};
  EXPECT_TRUE(update.is_grid());
  update.header().stamp = 5.0;
  EXPECT_EQ(std::get<OccupancyGrid>(update.msg).header.stamp, 5.0);
  update.msg =
      PointCloud2{.header = {7.0}, .origin = {}, .fields = {}, .is_bigendian = false, .point_step = 0};
  EXPECT_FALSE(update.is_grid());
  EXPECT_EQ(std::as_const(update).header().stamp, 7.0);
}

}  // namespace
}  // namespace adit::icd
