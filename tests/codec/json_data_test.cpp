// The map's data in JSON, split off as it arrives: base64 (ICD 6.3) or an array of integers.
#include <gtest/gtest.h>

#include "codec/documents.hpp"

namespace adit::codec::test {
namespace {

struct JsonCase {
  std::string body;
  std::string data;
  DataForm form = DataForm::Base64;
};

const std::vector<JsonCase> kGoodJsonData = {
    JsonCase{R"({"msg":{"data":"Zm9vYmFy"}})", "foobar"},
    JsonCase{R"({"msg":{"data":""}})", ""},
    JsonCase{R"({"a":[1,{"msg":3}],"msg":{"b":{"data":7},"data":"Zg==","c":"d"},"e":0})", "f"},
    JsonCase{R"({"msg":{"data":"Zg"}})", "f"},                   // no padding
    JsonCase{R"({"msg":{"data":"\/\/\/\/"}})", "\xff\xff\xff"},  // with escaped slashes
    JsonCase{R"({"msg":{"data":"\u002B\u002bAAZg\u003d\u003d"}})",
             std::string("\xfb\xe0\0f", 4)},  // as Gson does
    JsonCase{R"({"\u006Dsg":{"d\u0061ta":"Zm8="}})", "fo"},
    JsonCase{"\n{ \"msg\" : { \"data\" : \"Zm9v\" , \"x\" : 1 } }\n", "foo"},
    JsonCase{R"({"msg":{"data":[]}})", "", DataForm::Integers},
    JsonCase{R"({"msg":{"data":[0,100,-1,255,97]}})",
             std::string("\0d\xff\xff"
                         "a",
                         5),
             DataForm::Integers},
    JsonCase{"{\"msg\":{\"data\": [ 97 ,\n98\t, 99 ] , \"x\":[300]}}", "abc", DataForm::Integers},
    JsonCase{R"({"msg":{"data":[97.0,9.8e1,-1.0,-0,0.99E2]}})", std::string("ab\xff\0c", 5),
             DataForm::Integers}};

TEST(JsonData, IsSplitOutOfTheDocumentInEachForm) {
  for (const auto& [body, data, form] : kGoodJsonData) {
    for (const std::size_t size : {1, 2, 7, 1000000}) {
      const auto document = decode_in_chunks(kJsonBody, Split::MapData, body, size);
      ASSERT_TRUE(document) << document.error().sentence << " in " << body;
      EXPECT_EQ(document->data.to_string(), data) << body;
      EXPECT_EQ(document->data_form, form);
      const Value* const mark = msg_data(document->root);
      ASSERT_NE(mark, nullptr);
      EXPECT_TRUE(std::holds_alternative<Value::SplitOut>(mark->is));
    }
  }
}

TEST(JsonData, StaysInTheDocumentWithoutSplitting) {
  const auto document = decode(kJsonBody, Split::Nothing, R"({"msg":{"data":"Zm9v"}})");
  ASSERT_TRUE(document);
  EXPECT_EQ(document->data_form, DataForm::Absent);
  EXPECT_EQ(std::get<std::string>(msg_data(document->root)->is), "Zm9v");
}

TEST(JsonData, IsMarkedInTheRightMsgIfMsgIsGivenTwice) {
  const auto document = decode(kJsonBody, Split::MapData, R"({"msg":{"a":null},"msg":{"data":"Zm9v"}})");
  ASSERT_TRUE(document);
  const auto& second = std::get<Value::Object>(document->root.is)[1].second;
  EXPECT_TRUE(std::holds_alternative<Value::SplitOut>(std::get<Value::Object>(second.is)[0].second.is));
}

const std::vector<std::pair<std::string, std::string>> kBadJsonData = {
    {R"("Zm9v YmFy")", ": character 4: a space is not in the base64 alphabet"},
    {R"("Zm9v\nYmFy")", ": character 4: byte 0x0a is not in the base64 alphabet"},
    {R"("Zm9-")", ": character 3: '-' is not in the base64 alphabet"},
    {R"("Zm9vé")", ": character 4: byte 0xc3 is not in the base64 alphabet"},
    {R"("Zg=")", ": the base64 padding is cut short"},
    {R"("Z")", ": the base64 text is cut short"},
    {R"("Zg==Zg==")", ": character 4: unexpected character after the padding"},
    {"[1,256]", "[1]: expected an integer from -1 to 255, got 256"},
    {"[-2]", "[0]: expected an integer from -1 to 255, got -2"},
    {"[0,0,1.5]", "[2]: expected an integer from -1 to 255, got 1.5"},
    {"[1e999]", "[0]: expected an integer from -1 to 255, got 1e999"},
    {"[99999999999999999999999999999999999999]",
     "[0]: expected an integer from -1 to 255, got 99999999999999999999999999999999..."},
    {"[1,\"1\"]", "[1]: expected an integer from -1 to 255, got a string"},
    {"[[1]]", "[0]: expected an integer from -1 to 255, got an array"},
    {"[{}]", "[0]: expected an integer from -1 to 255, got an object"},
    {"[null]", "[0]: expected an integer from -1 to 255, got null"},
    {"[true]", "[0]: expected an integer from -1 to 255, got true or false"},
    {R"("Zm9v","data":"Zm9v")", ": given twice"},
    {R"("Zm9v","d\u0061ta":[1])", ": given twice"},
    {R"(null,"data":"Zm9v")", ": given twice"},
    {R"("Zm9v"},"msg":{"data":null)", ": given twice"},
};

TEST(JsonData, OfAnotherKindIsRejectedWith422AndTheElement) {
  for (const auto& [data, why] : kBadJsonData) {
    for (const std::size_t size : {1, 2, 7, 1000000}) {
      const auto document =
          decode_in_chunks(kJsonBody, Split::MapData, R"({"msg":{"data":)" + data + "}}", size);
      ASSERT_FALSE(document) << data;
      EXPECT_EQ(document.error().status, icd::Status::UnprocessableEntity);
      EXPECT_EQ(document.error().sentence, "msg.data" + why);
    }
  }
}

TEST(JsonData, IsRejectedWith400IfMalformed) {
  for (const std::string data :
       {"[1,]", "[,]", "[01]", "[1", "[1 2]", "[1}", "[-]", "\"Zm9v\n\"", "\"Zm9v\\q\"", "\"Zm9v\xff\""}) {
    const auto document = decode(kJsonBody, Split::MapData, R"({"msg":{"data":)" + data + "}}");
    ASSERT_FALSE(document) << data;
    EXPECT_EQ(document.error().status, icd::Status::BadRequest) << data;
  }
}

TEST(JsonData, CanBeTakenInPiecesAndStillCounts) {
  const Limits limits{.data_bytes = 6000};
  const auto feed = [](BodyDecoder& decoder, std::string_view text) {
    return decoder.feed({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  };
  BodyDecoder decoder(kJsonBody, Split::MapData, limits);
  ASSERT_TRUE(feed(decoder, R"({"msg":{"data":")" + std::string(4000, 'A')));
  EXPECT_EQ(decoder.held_bytes(), 3000u);
  const icd::ChunkedBytes first = decoder.take_data();
  EXPECT_EQ(first.to_string(), std::string(3000, '\0'));
  EXPECT_EQ(decoder.held_bytes(), 0u);
  ASSERT_TRUE(feed(decoder, "////"));
  ASSERT_TRUE(feed(decoder, "\"}}"));
  const auto document = decoder.finish();
  ASSERT_TRUE(document);
  EXPECT_EQ(document->data.to_string(), "\xff\xff\xff") << "the rest of the data";

  BodyDecoder too_much(kJsonBody, Split::MapData, limits);
  ASSERT_TRUE(feed(too_much, R"({"msg":{"data":")" + std::string(8000, 'A')));
  EXPECT_EQ(too_much.take_data().size(), 6000u);
  EXPECT_EQ(feed(too_much, "AAAA").error().status, icd::Status::ContentTooLarge);

  BodyDecoder elements(kJsonBody, Split::MapData, {});
  std::string text = R"({"msg":{"data":[0)";
  for (int i = 1; i < 5000; ++i) text += ",0";
  ASSERT_TRUE(feed(elements, text));
  EXPECT_EQ(elements.take_data().size(), 4096u);
  EXPECT_TRUE(feed(elements, ",true").error().sentence.starts_with("msg.data[5000]: "));
}

TEST(JsonData, HasItsOwnLimitAnsweredWith413) {
  const Limits limits{.text_bytes = 40, .data_bytes = 6000};
  const auto body = [](const std::string& data) { return R"({"msg":{"data":)" + data + "}}"; };
  const auto integers = [](std::size_t count) {
    std::string text = "[0";
    for (std::size_t i = 1; i < count; ++i) text += ",0";
    return text + "]";
  };
  EXPECT_TRUE(decode(kJsonBody, Split::MapData, body('"' + std::string(8000, 'A') + '"'), limits));
  EXPECT_TRUE(decode(kJsonBody, Split::MapData, body(integers(6000)), limits));
  for (const std::string& data : {'"' + std::string(8004, 'A') + '"', integers(6001)}) {
    const auto document = decode(kJsonBody, Split::MapData, body(data), limits);
    ASSERT_FALSE(document);
    EXPECT_EQ(document.error(),
              (icd::Refusal{icd::Status::ContentTooLarge, "msg.data: larger than the limit of 6000 bytes"}));
  }
  const auto blanks = decode(kJsonBody, Split::MapData, body(std::string(30000, ' ') + "[]"), limits);
  ASSERT_FALSE(blanks);
  EXPECT_EQ(blanks.error().status, icd::Status::ContentTooLarge);
}

}  // namespace
}  // namespace adit::codec::test
