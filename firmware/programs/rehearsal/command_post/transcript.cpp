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
