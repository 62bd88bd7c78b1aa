# Clang compiles the programs that ship: at -Oz they are a tenth smaller than GCC's, in half of the time, and its linker packs relative
# relocations for ARM as well as for x86. Clang also compiles the tests and the address sanitizer's build, in three fifths of GCC's time.
# GCC compiles the presets gcc, debug and tsan (.ci/nightly), so that two compilers read each line.
set(CMAKE_C_COMPILER clang-19)
set(CMAKE_CXX_COMPILER clang++-19)
set(CMAKE_AR llvm-ar-19)
set(CMAKE_RANLIB llvm-ranlib-19)
set(CMAKE_STRIP llvm-strip-19)
set(CMAKE_CXX_COMPILER_AR ${CMAKE_AR})
set(CMAKE_CXX_COMPILER_RANLIB ${CMAKE_RANLIB})
set(CMAKE_EXE_LINKER_FLAGS_INIT -fuse-ld=lld-19)
