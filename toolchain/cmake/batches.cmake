# Every target is compiled in batches: some files of it as one, for most of a file's time goes into headers that its neighbours include
# too. What ships, what is tested and what the sanitizers see is built the same way. So no two files of a room have a helper of the
# same name, not in their unnamed namespaces either; what two of them need is in a small header of the room. A file that has options
# of its own is compiled by itself. -DCMAKE_UNITY_BUILD=OFF compiles each by itself. What is mostly built from nothing (CMakePresets.json),
# and what toolchain/lint reads, has batches of twice as many, which take a quarter less in all.
option(CMAKE_UNITY_BUILD "Compile some files of a target as one" ON)
set(CMAKE_UNITY_BUILD_BATCH_SIZE 8 CACHE STRING "How many files, at most")
