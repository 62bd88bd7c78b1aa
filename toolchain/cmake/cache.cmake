# Compiles nothing twice: ccache, if it is installed (toolchain/setup test), keeps what each compiler run made, for every clone on this
# machine. Two clones in different directories share it, because all paths that reach the compiler are relative: batches (batches.cmake),
# ccache's base_dir, and no absolute path in a definition. It is never used for a release: what ships (link-time optimization) does
# without, but for an image that toolchain/image makes for tests.
#
# Clang writes absolute paths into a precompiled header. So these are compiled in each clone, without the cache, and ccache compares the
# sum of their headers that `renewed` (headers.cmake) keeps beside them.
find_program(ADIT_CCACHE ccache)
if(CMAKE_INTERPROCEDURAL_OPTIMIZATION)
  set(cache_usual OFF)
else()
  set(cache_usual ON)
endif()
option(ADIT_CACHE "Use the compiler cache if it is installed" ${cache_usual})
if(ADIT_CACHE AND ADIT_CCACHE)
  set(directory $ENV{XDG_CACHE_HOME})
  if(NOT directory)
    set(directory $ENV{HOME}/.cache)
  endif()
  # No option of the user's own cache is changed: this one is bounded by itself.
  set(launcher /usr/bin/env CCACHE_DIR=${directory}/adit/ccache CCACHE_MAXSIZE=2G CCACHE_BASEDIR=${PROJECT_SOURCE_DIR}
    CCACHE_NOHASHDIR=1 CCACHE_SLOPPINESS=pch_defines,time_macros CCACHE_PCH_EXTSUM=1 CCACHE_COMPRESSLEVEL=1 ${ADIT_CCACHE})
  set(CMAKE_C_COMPILER_LAUNCHER ${launcher})
  set(CMAKE_CXX_COMPILER_LAUNCHER ${launcher})
  # CMake also names the header that it writes for each target, which has absolute paths, and in words that ccache does not read.
  if(CMAKE_CXX_COMPILER_ID STREQUAL Clang)
    set(CMAKE_CXX_COMPILE_OPTIONS_USE_PCH -include-pch <PCH_FILE>)
  endif()
  add_compile_options(-ffile-prefix-map=${PROJECT_SOURCE_DIR}=.)
endif()
