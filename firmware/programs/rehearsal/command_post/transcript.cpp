#include "rehearsal/command_post/transcript.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iterator>

#include "rehearsal/command_post/pictures.hpp"

namespace adit::rehearsal {
namespace {

std::uint64_t lines_in(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return static_cast<std::uint64_t>(
      std::count(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>(), '\n'));
}

std::string stem_of(std::uint64_t number, const MapMessage& map) {
  char digits[32];
  const int length = std::snprintf(digits, sizeof digits, "%06llu", static_cast<unsigned long long>(number));
  return std::string(digits, static_cast<std::size_t>(length)) + "-" +
         (map.name.empty() ? "merged" : tame(map.name));
}

/// Replaces long texts and lists of a document by their sizes, so that a line of it can be read.
void shorten(Json& value) {
  constexpr std::size_t longest_text = 4096;
  constexpr std::size_t longest_list = 10'000;
  if (value.is_binary()) {
    value = {{"bytes", value.get_binary().size()}};
  } else if (value.is_string() && value.get_ref<const std::string&>().size() > longest_text) {
    value = {{"characters", value.get_ref<const std::string&>().size()}};
  } else if (value.is_structured() && value.size() > longest_list) {
    value = {{"elements", value.size()}};
  } else if (value.is_structured()) {
    for (Json& element : value) shorten(element);
  }
}

OrderedJson text_or_null(const std::optional<std::string>& text) {
  return text ? OrderedJson(*text) : nullptr;
}

}  // namespace

std::expected<std::unique_ptr<Transcript>, std::string> Transcript::open(const std::string& folder,
                                                                         std::uint64_t most) {
  std::unique_ptr<Transcript> transcript(new Transcript(folder, most));
  std::error_code error;
  for (const char* const kind : {"grids", "clouds"}) {
    std::filesystem::create_directories(std::filesystem::path(folder) / kind, error);
    if (error) return std::unexpected(folder + "/" + kind + ": " + error.message());
  }
  const std::string requests = folder + "/requests.jsonl";
  transcript->requests_ = lines_in(requests);
  transcript->requests_file_.open(requests, std::ios::binary | std::ios::app);
  transcript->reports_file_.open(folder + "/reports.jsonl", std::ios::binary | std::ios::app);
  if (!transcript->requests_file_ || !transcript->reports_file_) {
    return std::unexpected(folder + ": cannot be written");
  }
  return transcript;
}

std::optional<std::string> Transcript::picture(std::uint64_t number, const MapMessage& map) {
  const std::size_t size = picture_size(map);
  {
    const std::lock_guard lock(mutex_);
    if (written_ + size > most_) return std::nullopt;
    written_ += size;
  }
  const auto* const grid = std::get_if<Grid>(&map.msg);
  const std::string stem = (grid != nullptr ? "grids/" : "clouds/") + stem_of(number, map);
  const std::string path = folder_ + "/" + stem;
  const bool good = grid != nullptr ? write_grid_picture(*grid, map.data, path)
                                    : write_cloud_picture(std::get<Cloud>(map.msg), map.data, path);
  if (!good) return std::nullopt;
  return stem + (grid != nullptr ? ".pgm" : ".pcd");
}

void Transcript::request(std::uint64_t number, const char* endpoint, const Request& request,
                         Judgement& judgement) {
  constexpr std::size_t longest_message = std::size_t{1} << 20;
  OrderedJson message;
  if (judgement.message) {
    if (judgement.map) {
      const auto file = picture(number, *judgement.map);
      (*judgement.message)["msg"]["data"]["file"] = file ? Json(*file) : Json(nullptr);
    }
    shorten(*judgement.message);
    message = *judgement.message;
    const std::size_t length = line_of(message).size();
    if (length > longest_message) message = {{"characters", length}};
  }
  const Outcome& outcome = judgement.outcome;
  const bool answered = outcome.kind == Outcome::Kind::Answered && outcome.answer.status != 0;
  const OrderedJson line = {
      {"number", number},
      {"at", std::chrono::duration<double>(request.at - opened_).count()},
      {"endpoint", endpoint},
      {"method", request.method},
      {"uri", request.target},
      {"content_type", text_or_null(request.content_type)},
      {"content_encoding", text_or_null(request.content_encoding)},
      {"expect", request.expects_continue},
      {"authorization", request.authorization.has_value()},
      {"body_bytes", request.body.size()},
      {"status", answered ? OrderedJson(outcome.answer.status) : OrderedJson(nullptr)},
      {"answer", answered ? OrderedJson(outcome.answer.body) : OrderedJson(nullptr)},
      {"message", std::move(message)},
      {"fault", request.fault ? OrderedJson(request.fault->sentence) : OrderedJson(nullptr)},
      {"rehearsed_fault", judgement.fault.empty() ? OrderedJson(nullptr) : OrderedJson(judgement.fault)},
      {"violations", judgement.findings.violations()}};
  append(requests_file_, line);
}

void Transcript::append(std::ofstream& file, const OrderedJson& line) {
  const std::string text = line_of(line) + "\n";
  const std::lock_guard lock(mutex_);
  written_ += text.size();
  file << text << std::flush;
  if (file || complained_) return;
  complained_ = true;
  file.clear();
  std::fprintf(stderr, "adit-rehearsal: %s: cannot write a line; the disk may be full\n", folder_.c_str());
}

}  // namespace adit::rehearsal
