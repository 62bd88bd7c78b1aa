# Compile up to 16 files of a target as one: most of the time of a file goes into headers that its neighbours include too. So no two
# files of a room may define a helper of the same name, not even in unnamed namespaces. Files with options of their own are compiled
# by themselves. -DCMAKE_UNITY_BUILD=OFF compiles each file by itself.
option(CMAKE_UNITY_BUILD "Compile several files of a target as one" ON)
set(CMAKE_UNITY_BUILD_BATCH_SIZE 16)
