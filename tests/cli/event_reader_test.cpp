#include "cli/event_reader.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace adit::cli {
namespace {

constexpr std::string_view kStream =
    "retry: 1000\ndata: {\"now\":1}\n\n:\n\nevent: patch\ndata: {\"now\":2}\n\ndata: {\"now\":3}\n\ndata: "
    "{\"no";

/// "type data", fed in pieces of so many bytes.
std::vector<std::string> events(std::size_t piece) {
  EventReader reader;
  std::vector<std::string> all;
  for (std::size_t at = 0; at < kStream.size(); at += piece) {
    reader.feed(kStream.substr(at, piece));
    while (const auto event = reader.next()) all.push_back(event->type + ' ' + event->data);
  }
  EXPECT_EQ(reader.waiting(), 10);
  return all;
}

TEST(EventReader, GivesEachWholeEventThatHasData_HoweverItCame) {
  const std::vector<std::string> all = {" {\"now\":1}", "patch {\"now\":2}", " {\"now\":3}"};
  for (std::size_t piece = 1; piece <= kStream.size(); ++piece) EXPECT_EQ(events(piece), all) << piece;
}

}  // namespace
}  // namespace adit::cli
