# What every target is compiled with: warnings are errors, and the hardening that Debian's own packages have, and more. Branch protection
# (-fcf-protection: 48 kB in aditd; -mbranch-protection) would do nothing: Debian 12's start files and libraries have no marks for it.
add_library(adit_options INTERFACE)
target_compile_options(adit_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor
  -Woverloaded-virtual -Wimplicit-fallthrough -Werror
  $<$<CXX_COMPILER_ID:Clang>:-Wno-deprecated-declarations>  # inside libstdc++'s own headers; GCC finds ours
  $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>  # GCC takes a batch's files, and what is in a template's argument, for headers
  -fstack-protector-strong -fstack-clash-protection -ffunction-sections -fdata-sections -fPIE)
target_compile_definitions(adit_options INTERFACE _GLIBCXX_ASSERTIONS)
target_link_options(adit_options INTERFACE -pie -Wl,-z,relro,-z,now -Wl,--gc-sections)
# Small, but for what says otherwise: headers.cmake has the ways to be compiled.
set(CMAKE_CXX_FLAGS_RELEASE "-Os -DNDEBUG")

if(CMAKE_TOOLCHAIN_FILE AND NOT CMAKE_CXX_COMPILER_ID STREQUAL Clang)  # in a folder from before: CMake keeps to a compiler
  message(FATAL_ERROR "${CMAKE_BINARY_DIR} is of another compiler than ${CMAKE_TOOLCHAIN_FILE} names: remove it, and say --preset again")
endif()
if(CMAKE_INTERPROCEDURAL_OPTIMIZATION)  # what ships: see ships.cmake
  set(CMAKE_CXX_FLAGS_RELEASE "-Oz -DNDEBUG")
  # As one program, not in parts. Nothing asks for a type at run time, and the types' names are long; the stack is unwound where
  # something throws, not at each instruction. Equal functions are one: the compiler finds 20 kB of them that the linker does not.
  # The optimized sources are inlined as they are compiled; inlining more at the link only adds 70 kB.
  set(CMAKE_CXX_COMPILE_OPTIONS_IPO -flto=full)
  target_compile_options(adit_options INTERFACE -fno-rtti -fno-asynchronous-unwind-tables)
  target_link_options(adit_options INTERFACE -flto=full -Wl,--icf=safe -Wl,-mllvm,-enable-merge-functions
    -Wl,-mllvm,-inline-threshold=-40 -Wl,-O2 -Wl,-z,pack-relative-relocs)
endif()

set(ADIT_SANITIZE "" CACHE STRING "Sanitizers to build with, as -fsanitize takes them (address,undefined or thread)")
if(ADIT_SANITIZE)
  # The compiler's package has no runtime of its sanitizers, and a program without one fails to link after minutes.
  include(CheckCXXSourceCompiles)
  unset(ADIT_HAS_SANITIZER CACHE)
  set(CMAKE_REQUIRED_FLAGS -fsanitize=${ADIT_SANITIZE})
  check_cxx_source_compiles("int main() {}" ADIT_HAS_SANITIZER)
  unset(CMAKE_REQUIRED_FLAGS)
  if(NOT ADIT_HAS_SANITIZER)
    message(FATAL_ERROR "${CMAKE_CXX_COMPILER} cannot link with -fsanitize=${ADIT_SANITIZE}: run toolchain/setup run test sanitizers")
  endif()
  target_compile_options(adit_options INTERFACE -fsanitize=${ADIT_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer
    # GCC's manual: warnings that follow a value through the code give false alarms with -fsanitize. The preset gcc has them.
    $<$<CXX_COMPILER_ID:GNU>:-Wno-error> $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  if(ADIT_SANITIZE MATCHES thread)  # GCC: its sanitizer knows no fences (ChunkedBytes, Asio)
    target_compile_options(adit_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-tsan>)
  endif()
  target_link_options(adit_options INTERFACE -fsanitize=${ADIT_SANITIZE})
else()
  target_compile_definitions(adit_options INTERFACE $<$<CONFIG:Release>:_FORTIFY_SOURCE=2>)
endif()
