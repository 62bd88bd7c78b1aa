#include <gtest/gtest.h>

#include <ostream>
#include <string>

#include "dispatch/verdicts.hpp"

namespace adit::dispatch {
namespace {

using Verdict = MappingVerdict;

constexpr const char* kPage = "<!DOCTYPE html><html>log in to the network</html>";
constexpr const char* kSentence = R"("Cloud updates too frequent.")";

struct MappingCase {
  int status;
  std::string body;
  Verdict verdict;
  bool is_plausible_answer;
};
void PrintTo(const MappingCase& one, std::ostream* out) {
  *out << one.status << " " << one.body;
}

const MappingCase kMappingCases[] = {
    // The body decides.
    {200, "null", Verdict::Taken, true},
    {200, "", Verdict::Taken, true},
    {200, " \r\n", Verdict::Taken, true},
    {200, kSentence, Verdict::Taken, true},
    {204, "", Verdict::Taken, true},
    {200, kPage, Verdict::Failing, false},
    {200, "OK", Verdict::Failing, false},
    {200, "{\"a\":", Verdict::Failing, false},
    {200, std::string("\0\x01", 2), Verdict::Failing, false},
    {204, kPage, Verdict::Failing, false},
    // Not the Command Post's.
    {301, "", Verdict::Failing, false},
    // Rejected only by the Command Post itself.
    {400, kSentence, Verdict::Refused, true},
    {413, "", Verdict::TooLarge, true},
    {413, kSentence, Verdict::TooLarge, true},
    {413, kPage, Verdict::TooLarge, false},
    {422, kSentence, Verdict::Refused, true},
    {400, kPage, Verdict::Suspect, false},
    {422, kPage, Verdict::Suspect, false},
    // Throttled, whatever sent the 429.
    {429, kSentence, Verdict::Throttled, true},
    {429, kPage, Verdict::Throttled, true},
    // Failures.
    {500, kPage, Verdict::Suspect, true},
    {500, "", Verdict::Suspect, true},
    {500, kSentence, Verdict::Suspect, true},
    {409, kSentence, Verdict::Suspect, true},
    {415, "", Verdict::Suspect, true},
    {401, kSentence, Verdict::Failing, true},
    {401, kPage, Verdict::Failing, false},
    {404, kPage, Verdict::Failing, true},
    {404, kSentence, Verdict::Failing, true},
    {503, kPage, Verdict::Failing, true},
};

class MappingVerdicts : public testing::TestWithParam<MappingCase> {};

TEST_P(MappingVerdicts, FollowStatusAndBody) {
  const Body body = body_of(GetParam().body);
  EXPECT_EQ(mapping_verdict(GetParam().status, body), GetParam().verdict);
  EXPECT_EQ(is_plausible_answer(GetParam().status, body), GetParam().is_plausible_answer);
}
INSTANTIATE_TEST_SUITE_P(, MappingVerdicts, testing::ValuesIn(kMappingCases));

}  // namespace
}  // namespace adit::dispatch
