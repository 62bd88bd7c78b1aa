#include "project_files.hpp"

#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>

namespace adit {

std::filesystem::path project_file(std::string_view path) {
  return std::filesystem::path(ADIT_SOURCE_DIRECTORY) / path;
}

std::string project_text(std::string_view path) {
  std::ifstream stream(project_file(path));
  if (!stream) {
    std::cerr << "cannot read " << project_file(path) << '\n';
    std::abort();
  }
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::filesystem::path built_program(std::string_view name) {
  return std::filesystem::path(ADIT_PROGRAMS_DIRECTORY) / name;
}

}  // namespace adit
