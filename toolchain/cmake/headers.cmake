# The ways to be compiled: options, and the library headers that most files include, read once for all of them, for half of the time
# of a build would go into them. A file includes what it uses all the same: the linter reads each by itself.
#   adit_way(fast HEADERS <vector> OPTIONS -O3 LIBRARIES ZLIB::ZLIB)
# OPTIONS hold for every target of that way (adit_compiled), and are those of the headers.
find_program(ADIT_JQ jq REQUIRED)  # for renewed
if(CMAKE_CXX_COMPILER_ID STREQUAL Clang)  # renewed compares headers by their content
  list(APPEND CMAKE_CXX_COMPILE_OPTIONS_CREATE_PCH -Xclang -fno-pch-timestamp)
endif()
function(adit_way name)
  cmake_parse_arguments(WAY "" "" "HEADERS;OPTIONS;LIBRARIES" ${ARGN})
  set(source ${CMAKE_BINARY_DIR}/headers/${name}.cpp)
  set(stamp ${CMAKE_BINARY_DIR}/headers/${name}.hpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "")
  add_custom_target(adit_renewed_${name} BYPRODUCTS ${stamp} COMMENT "Checking precompiled header ${name}" VERBATIM
    COMMAND ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/renewed ${stamp} ${CMAKE_BINARY_DIR}/compile_commands.json
      ${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/adit_way_${name}.dir/cmake_pch.hxx)
  add_library(adit_way_${name} OBJECT EXCLUDE_FROM_ALL ${source})
  set_target_properties(adit_way_${name} PROPERTIES CXX_COMPILER_LAUNCHER "")  # cache.cmake
  add_dependencies(adit_way_${name} adit_renewed_${name})
  target_compile_options(adit_way_${name} PUBLIC ${WAY_OPTIONS})
  target_link_libraries(adit_way_${name} PRIVATE adit_options ${WAY_LIBRARIES})
  target_precompile_headers(adit_way_${name} PRIVATE ${stamp} ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/assertions.hpp ${WAY_HEADERS}
    <algorithm> <array> <charconv> <chrono> <cmath> <cstdint> <expected> <functional> <map> <memory> <optional> <span> <string>
    <string_view> <utility> <vector>)
endfunction()

function(adit_compiled target way)
  target_compile_options(${target} PRIVATE $<TARGET_PROPERTY:adit_way_${way},INTERFACE_COMPILE_OPTIONS>)
  target_precompile_headers(${target} REUSE_FROM adit_way_${way})
  adit_batches(${target})
endfunction()

adit_way(small)
adit_way(fast OPTIONS $<$<CONFIG:Release>:-O3>)  # what works on each byte of a map
if(ADIT_TESTS OR ADIT_REHEARSAL)
  find_package(nlohmann_json REQUIRED)
  adit_way(soon HEADERS <nlohmann/json.hpp> LIBRARIES nlohmann_json::nlohmann_json
    OPTIONS $<$<CONFIG:Release>:-O1> $<$<AND:$<CONFIG:Release>,$<CXX_COMPILER_ID:GNU>>:-Wno-maybe-uninitialized>)  # which it raises falsely at -O1
endif()
