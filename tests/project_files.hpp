/// Files of the project and programs of this build. Only project_files.cpp knows where they are, so that
/// tests compile to the same bytes in every clone.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace adit {

/// The absolute path of a file of the project, given from its root: "board/card.html".
std::filesystem::path project_file(std::string_view path);

/// The content of that file. Ends the test program if the file cannot be read.
std::string project_text(std::string_view path);

/// The absolute path of a program that this build makes: "adit-robots".
std::filesystem::path built_program(std::string_view name);

}  // namespace adit
