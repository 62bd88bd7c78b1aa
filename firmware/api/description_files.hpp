#pragma once

#include <span>

#include "site/site.hpp"

/// What description.cpp begins with, embedded in the program.
namespace adit::api::open_api {

using site::File;
std::span<const File> embedded_files();  // openapi.json, schemas.json

}  // namespace adit::api::open_api
