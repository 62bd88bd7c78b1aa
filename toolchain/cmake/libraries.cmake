# The libraries of Debian that the rooms link, each an imported target. A room's CMakeLists.txt names those it may use.
find_package(PkgConfig REQUIRED)
find_package(ZLIB REQUIRED)
find_package(Threads REQUIRED)
pkg_check_modules(microhttpd REQUIRED IMPORTED_TARGET libmicrohttpd>=0.9.75)
pkg_check_modules(cjson REQUIRED IMPORTED_TARGET libcjson)
pkg_check_modules(deflate REQUIRED IMPORTED_TARGET libdeflate)
pkg_check_modules(systemd REQUIRED IMPORTED_TARGET libsystemd)
pkg_check_modules(gpiod REQUIRED IMPORTED_TARGET libgpiod<3)
string(REGEX MATCH "^[0-9]+" gpiod_MAJOR ${gpiod_VERSION})  # 1 in Debian 12, 2 in Debian 13
pkg_check_modules(crypt REQUIRED IMPORTED_TARGET libcrypt)
pkg_check_modules(sodium REQUIRED IMPORTED_TARGET libsodium)
