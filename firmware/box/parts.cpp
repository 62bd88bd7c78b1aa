#include "box/parts.hpp"

#include <cJSON.h>
#include <crypt.h>
#include <gnu/libc-version.h>
#include <libdeflate.h>
#include <microhttpd.h>
#include <sodium.h>
#include <zlib.h>

#include <boost/version.hpp>

#include "box/build.hpp"
#include "icd/sentence.hpp"
#include "panel/lines.hpp"

namespace adit::box {
namespace {

constexpr const char* kLesserGpl = "LGPL-2.1-or-later";

std::string dotted(int major, int minor, int patch) {
  return icd::sentence(major, ".", minor, ".", patch);
}

std::string boost_version() {
  return dotted(BOOST_VERSION / 100000, BOOST_VERSION / 100 % 1000, BOOST_VERSION % 100);
}

}  // namespace

std::vector<api::PartRow> parts() {
  return {{.name = "libmicrohttpd", .version = MHD_get_version(), .licence = kLesserGpl},
          {.name = "cJSON", .version = cJSON_Version(), .licence = "MIT"},
          {.name = "zlib", .version = zlibVersion(), .licence = "Zlib"},
          {.name = "libdeflate", .version = LIBDEFLATE_VERSION_STRING, .licence = "MIT"},
          {.name = "Boost.Beast", .version = boost_version(), .licence = "BSL-1.0"},
          {.name = "libsystemd", .version = kSystemdVersion, .licence = kLesserGpl},
          {.name = "libgpiod", .version = panel::gpiod_version(), .licence = kLesserGpl},
          {.name = "libcrypt", .version = XCRYPT_VERSION_STR, .licence = kLesserGpl},
          {.name = "libsodium", .version = sodium_version_string(), .licence = "ISC"},
          {.name = "glibc", .version = gnu_get_libc_version(), .licence = kLesserGpl}};
}

std::string build_text() {
  const std::string_view commit = kCommit;
  return icd::sentence(commit, commit.empty() ? "" : ", ", kCompiler, ", ", kBuildType);
}

}  // namespace adit::box
