# Compile options every target of ours shares; nothing is set globally.
add_library(slideway_options INTERFACE)
target_compile_options(slideway_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
                       -Wno-sign-conversion -Wno-missing-field-initializers -ffp-contract=off)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")  # GCC 12 takes "a" + text for what overflows
  target_compile_options(slideway_options INTERFACE -Wno-array-bounds -Wno-restrict
                         -Wno-stringop-overflow)
endif()
target_link_options(slideway_options INTERFACE -Wl,-z,relro,-z,now,-z,noexecstack)
if(SLIDEWAY_SANITIZE)
  target_compile_options(slideway_options INTERFACE -fsanitize=${SLIDEWAY_SANITIZE}
                         -fno-sanitize-recover=all -fno-omit-frame-pointer)
  if(SLIDEWAY_SANITIZE MATCHES undefined)
    # A quarter of the compile time, and the address checks see it; the last: Eigen's blocks of
    # matrices without columns.
    target_compile_options(slideway_options INTERFACE
                           -fno-sanitize=vptr,null,alignment,object-size,pointer-overflow)
  endif()
  target_link_options(slideway_options INTERFACE -fsanitize=${SLIDEWAY_SANITIZE})
endif()
if(SLIDEWAY_COVERAGE)
  # Functions are counted before they are inlined, and only ours.
  target_compile_options(slideway_options INTERFACE --coverage -fprofile-update=atomic
                         -fprofile-exclude-files=^/usr/ -fno-early-inlining -finline-functions
                         -finline-small-functions)
  target_link_options(slideway_options INTERFACE --coverage -Wl,--wrap=_exit,--wrap=execve,--wrap=kill
                      -Wl,-u,__wrap__exit)
  add_library(slideway_counted_exit STATIC ${CMAKE_CURRENT_LIST_DIR}/counted_exit.cpp)
  set_target_properties(slideway_counted_exit PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_link_libraries(slideway_options INTERFACE slideway_counted_exit)
endif()

# slideway_light(target): makes text, not numbers; in a debug build it is compiled longer than it runs.
function(slideway_light target)
  if(CMAKE_BUILD_TYPE STREQUAL "Debug")
    target_compile_options(${target} PRIVATE -O0)
    set_target_properties(${target} PROPERTIES DISABLE_PRECOMPILE_HEADERS ON)  # those are of -O1
  endif()
endfunction()

# slideway_room(name SOURCES a.cpp ... DEPENDS slideway::x ... PRIVATE_DEPENDS lib ...
#               HEADER_ONLY lib ...)
# One room of the house: sources in src/<name>, public headers in include/slideway/<name>. The
# link line is the layer arrow. What is HEADER_ONLY and private, who installs slideway need not have.
function(slideway_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;DEPENDS;PRIVATE_DEPENDS;HEADER_ONLY" ${ARGN})
  add_library(slideway_${name} STATIC ${ROOM_SOURCES})
  add_library(slideway::${name} ALIAS slideway_${name})
  set_target_properties(slideway_${name} PROPERTIES EXPORT_NAME ${name}
                        POSITION_INDEPENDENT_CODE ON)  # for the Python module
  target_compile_features(slideway_${name} PUBLIC cxx_std_20)
  target_include_directories(slideway_${name} PUBLIC
                             $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>)
  target_link_libraries(slideway_${name} PUBLIC ${ROOM_DEPENDS} PRIVATE ${ROOM_PRIVATE_DEPENDS})
  foreach(library IN ITEMS slideway_options ${ROOM_HEADER_ONLY})
    target_link_libraries(slideway_${name} PRIVATE $<BUILD_INTERFACE:${library}>)
  endforeach()
  if(name MATCHES "^(format|report|batch|serve)$")
    slideway_light(slideway_${name})
  endif()
  if(NOT name MATCHES "^(base|format)$")  # these two use none of it
    slideway_use_headers(slideway_${name} slideway_room_headers)
  endif()
  set_property(GLOBAL APPEND PROPERTY SLIDEWAY_ROOMS slideway_${name})
endfunction()

# slideway_test(room SOURCES a_test.cpp ... DEPENDS lib ... [SLOW Suite.Case ...] [LONG Suite.Case ...])
# One GoogleTest program per folder of tests, its cases registered as <room>/<Suite>.<Case>. It links
# the room of its name if there is one. Cases under SLOW (patterns) get the label "slow", those under
# LONG the label "long": ./dev torture runs them. Under AddressSanitizer both are left out, and the
# others run in a few processes, <room>/part<n>.
function(slideway_test room)
  cmake_parse_arguments(TEST "" "" "SOURCES;DEPENDS;SLOW;LONG" ${ARGN})
  add_executable(${room}_test ${TEST_SOURCES})
  # Beyond so many files, names of one meet those of another.
  set_target_properties(${room}_test PROPERTIES UNITY_BUILD_BATCH_SIZE 16)
  target_include_directories(${room}_test PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_link_libraries(${room}_test PRIVATE $<TARGET_NAME_IF_EXISTS:slideway::${room}>
                        slideway_options ${TEST_DEPENDS} GTest::gmock_main)
  target_compile_definitions(${room}_test PRIVATE
    SLIDEWAY_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  slideway_use_headers(${room}_test slideway_test_headers)
  list(JOIN TEST_SLOW ":" slow)
  list(JOIN TEST_LONG ":" long)
  if(SLIDEWAY_SANITIZE MATCHES address)  # the start of a process takes longer than most cases
    set(parts 4)
    math(EXPR last "${parts} - 1")
    foreach(part RANGE ${last})
      add_test(NAME ${room}/part${part} COMMAND ${room}_test "--gtest_filter=-${slow}:${long}" --gtest_brief=1)
      set_tests_properties(${room}/part${part} PROPERTIES TIMEOUT 1200
        ENVIRONMENT "GTEST_TOTAL_SHARDS=${parts};GTEST_SHARD_INDEX=${part}")
    endforeach()
    return()
  endif()
  gtest_discover_tests(${room}_test TEST_PREFIX ${room}/ NO_PRETTY_VALUES DISCOVERY_TIMEOUT 60
                       TEST_FILTER "-${slow}:${long}" PROPERTIES TIMEOUT 600)
  if(slow)
    gtest_discover_tests(${room}_test TEST_PREFIX ${room}/ NO_PRETTY_VALUES DISCOVERY_TIMEOUT 60
                         TEST_FILTER "${slow}:-${long}" TEST_LIST ${room}_test_SLOW_TESTS
                         PROPERTIES TIMEOUT 600 LABELS slow)
  endif()
  if(long)
    gtest_discover_tests(${room}_test TEST_PREFIX ${room}/ NO_PRETTY_VALUES DISCOVERY_TIMEOUT 60
                         TEST_FILTER "${long}" TEST_LIST ${room}_test_LONG_TESTS
                         PROPERTIES TIMEOUT 1800 LABELS long)
  endif()
endfunction()
