# A room: one folder firmware/<floor>/<name>, one static library adit_<name>, one namespace adit::<name>.
#   adit_room(codec SOURCES json.cpp cbor.cpp OPTIMIZED_SOURCES base64.cpp ROOMS icd LIBRARIES PkgConfig::cjson)
# SOURCES are compiled to be small (WAY: or as it says, headers.cmake), OPTIMIZED_SOURCES ones to be fast: what works on each byte of a map or each number of a state.
# ROOMS are the rooms whose headers it includes, all of them named before it in firmware/CMakeLists.txt.
# PUBLIC_HEADERS are the headers that other rooms may include: tests/house/rooms sees to it.
# PLATFORM_SOURCES are sources that meet the machine (time, threads, sockets, randomness). They are a library of their own,
# adit_<name>_linux, which comes with adit_<name> into every program but those with the property ADIT_SIMULATED: such a
# program implements their headers itself.
function(adit_room name)
  cmake_parse_arguments(ROOM "" "WAY" "SOURCES;OPTIMIZED_SOURCES;PLATFORM_SOURCES;PUBLIC_HEADERS;ROOMS;LIBRARIES" ${ARGN})
  list(TRANSFORM ROOM_ROOMS PREPEND adit_)
  file(RELATIVE_PATH place ${PROJECT_SOURCE_DIR}/firmware ${CMAKE_CURRENT_SOURCE_DIR})
  string(REGEX REPLACE "/.*" "" floor ${place})
  if(NOT ROOM_WAY)
    set(ROOM_WAY small)
  endif()
  set(scope PUBLIC)
  if(ROOM_OPTIMIZED_SOURCES)
    add_library(adit_${name}_fast OBJECT ${ROOM_OPTIMIZED_SOURCES})
    target_include_directories(adit_${name}_fast PRIVATE ${PROJECT_SOURCE_DIR}/firmware/${floor})
    target_link_libraries(adit_${name}_fast PRIVATE adit_options ${ROOM_ROOMS} ${ROOM_LIBRARIES})
    adit_compiled(adit_${name}_fast fast)
    list(APPEND ROOM_SOURCES $<TARGET_OBJECTS:adit_${name}_fast>)
  endif()
  if(ROOM_SOURCES)
    add_library(adit_${name} STATIC ${ROOM_SOURCES})
    set_target_properties(adit_${name} PROPERTIES LINKER_LANGUAGE CXX)
    target_link_libraries(adit_${name} PRIVATE adit_options)
    adit_compiled(adit_${name} ${ROOM_WAY})
  else()
    add_library(adit_${name} INTERFACE)
    set(scope INTERFACE)
  endif()
  target_include_directories(adit_${name} ${scope} ${PROJECT_SOURCE_DIR}/firmware/${floor})
  target_link_libraries(adit_${name} ${scope} ${ROOM_ROOMS} ${ROOM_LIBRARIES})
  if(ROOM_PLATFORM_SOURCES)
    add_library(adit_${name}_linux STATIC ${ROOM_PLATFORM_SOURCES})
    target_link_libraries(adit_${name}_linux PRIVATE adit_options PUBLIC adit_${name})
    target_link_libraries(adit_${name} PUBLIC $<$<NOT:$<BOOL:$<TARGET_PROPERTY:ADIT_SIMULATED>>>:adit_${name}_linux>)
  endif()
endfunction()

# The tests of a room: tests/<name>/*.cpp become the one program adit_<name>_test.
#   adit_room_test(codec SOURCES json_test.cpp LIBRARIES nlohmann_json::nlohmann_json)
# WAITS: how many seconds the program waits more than it computes, mostly for deadlines and the disk. Then it begins early, in shares of
# about 30 s that run at once.
function(adit_room_test name)
  cmake_parse_arguments(TEST "" "WAITS" "SOURCES;ROOMS;LIBRARIES" ${ARGN})
  list(TRANSFORM TEST_ROOMS PREPEND adit_)
  add_executable(adit_${name}_test ${TEST_SOURCES})
  target_include_directories(adit_${name}_test PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_link_libraries(adit_${name}_test PRIVATE
    adit_options adit_project_files adit_${name} ${TEST_ROOMS} ${TEST_LIBRARIES} GTest::gmock GTest::gtest_main)
  adit_compiled(adit_${name}_test test)
  adit_google_test(${name} adit_${name}_test ${TEST_WAITS})
endfunction()

# A program of GoogleTest's as one test: a process for each of its tests would take twice as long in all.
function(adit_google_test room program)  # ARGN: WAITS
  set(shares 1)
  set(when COST 300 PROCESSORS 6)
  if(ARGN)
    math(EXPR shares "(${ARGN} + 29) / 30")
    set(when COST 972 PROCESSORS 2)
  endif()
  foreach(share RANGE 1 ${shares})
    set(name "${room}: ${program}")
    if(shares GREATER 1)
      string(APPEND name " ${share} of ${shares}")
    endif()
    math(EXPR index "${share} - 1")
    add_test(NAME "${name}" COMMAND ${program} --gtest_brief=1)
    set_tests_properties("${name}" PROPERTIES ${when} LABELS "${room};rooms"
      ENVIRONMENT "GTEST_TOTAL_SHARDS=${shares};GTEST_SHARD_INDEX=${index}")
  endforeach()
endfunction()
