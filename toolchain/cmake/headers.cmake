# The library headers that most files include, read once for all of them: half of the time of a build would go into them. A file
# includes what it uses all the same: the box's build and the linter read each by itself.
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/headers/room.cpp CONTENT "")
add_library(adit_room_headers OBJECT EXCLUDE_FROM_ALL ${CMAKE_BINARY_DIR}/headers/room.cpp)
target_link_libraries(adit_room_headers PRIVATE adit_options)
target_precompile_headers(adit_room_headers PRIVATE
  <algorithm> <array> <charconv> <chrono> <cmath> <cstdint> <expected> <functional> <map> <memory> <optional> <span> <string>
  <string_view> <utility> <vector>)

# Those of the tests: programs, whose code is compiled as a program's is.
function(adit_test_headers)
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/headers/test.cpp CONTENT "int main() {}\n")
  add_executable(adit_test_headers EXCLUDE_FROM_ALL ${CMAKE_BINARY_DIR}/headers/test.cpp)
  target_compile_options(adit_test_headers PRIVATE -O0)
  target_link_libraries(adit_test_headers PRIVATE adit_options GTest::gmock)
  target_precompile_headers(adit_test_headers PRIVATE
    <gmock/gmock.h> <gtest/gtest.h> <nlohmann/json.hpp> <algorithm> <array> <chrono> <expected> <filesystem> <fstream> <functional> <map> <memory>
    <optional> <random> <span> <string> <string_view> <utility> <vector>)
endfunction()
