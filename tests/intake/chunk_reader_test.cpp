#include <gtest/gtest.h>

#include "intake/odd_heads.hpp"
#include "intake/read_chunks.hpp"

namespace adit::intake {
namespace {

using State = ChunkReader::State;

TEST(Chunks, AreRejectedIfTheRfcForbidsThem) {
  RecordProperty("cases", static_cast<int>(odd_chunks().size()));  // tests/hostile/run counts them
  for (const OddChunks& odd : odd_chunks()) {
    for (const std::size_t piece : {odd.body.size(), std::size_t{1}, std::size_t{3}}) {
      EXPECT_EQ(read_chunks(odd.body, piece).state, State::Refused) << odd.what << " in pieces of " << piece;
    }
  }
}

TEST(Chunks, AreReadInPiecesOfAnySize) {
  const std::string bodies[] = {
      "3\r\nin \r\n6\r\nchunks\r\n0\r\n\r\n",
      "0003;ext=1;b\r\nin \r\n6 ; quoted=\"a;b\"\r\nchunks\r\n000\r\n\r\n",
      "9\r\nin chunks\r\n0;last\r\nTrailer: x\r\nAnother:\r\n\r\n",
      "1\r\ni\r\n8\r\nn chunks\r\n0\r\n\r\nGET / HTTP/1.1\r\n\r\n",
  };
  for (const std::string& body : bodies) {
    for (const std::size_t piece : {body.size(), std::size_t{1}, std::size_t{2}, std::size_t{5}}) {
      const ReadChunks outcome = read_chunks(body, piece);
      EXPECT_EQ(outcome.state, State::Whole) << body;
      EXPECT_EQ(outcome.data, "in chunks") << body;
    }
  }
}

TEST(Chunks, EndWithTheirLastLine) {
  const std::string body = "A\r\n0123456789\r\n0\r\n\r\n";
  for (std::size_t size = 0; size < body.size(); ++size) {
    EXPECT_EQ(read_chunks(std::string_view(body).substr(0, size), 1).state, State::More) << size;
  }
}

}  // namespace
}  // namespace adit::intake
