# Heavy headers, parsed once for the rooms and once for the tests, and what of Eigen is compiled once.
# Off in the presets dev and tidy, where a file must name what it uses.

# slideway_headers(name source header ...): a set of precompiled headers, and the source beside it.
function(slideway_headers name source)
  if(CMAKE_DISABLE_PRECOMPILE_HEADERS)
    return()
  endif()
  add_library(${name} OBJECT ${source})
  set_target_properties(${name} PROPERTIES UNITY_BUILD OFF)
  target_link_libraries(${name} PRIVATE slideway_options Eigen3::Eigen nlohmann_json::nlohmann_json)
  target_precompile_headers(${name} PRIVATE
    ${PROJECT_SOURCE_DIR}/cmake/compiled_once.hpp <nlohmann/json.hpp> <algorithm> <array> <cmath>
    <filesystem> <functional> <map> <memory> <optional> <span> <string> <vector> ${ARGN})
endfunction()

# slideway_use_headers(target name): what they say is compiled once goes into every archive, so that
# the linker finds ours before those of Ceres.
function(slideway_use_headers target name)
  if(CMAKE_DISABLE_PRECOMPILE_HEADERS)
    return()
  endif()
  target_precompile_headers(${target} REUSE_FROM ${name})
  get_target_property(type ${target} TYPE)
  if(type STREQUAL STATIC_LIBRARY)
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:${name}>)
  endif()
endfunction()

set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS cmake/compiled_once.hpp)
file(READ ${PROJECT_SOURCE_DIR}/cmake/compiled_once.hpp once)
string(REPLACE "extern template" "template" once "${once}")
string(REPLACE "#pragma once\n" "" once "${once}")
file(CONFIGURE OUTPUT compiled_once.cpp CONTENT "${once}" @ONLY)
slideway_headers(slideway_room_headers ${PROJECT_BINARY_DIR}/compiled_once.cpp)
if(TARGET slideway_room_headers)
  set_target_properties(slideway_room_headers PROPERTIES POSITION_INDEPENDENT_CODE ON)
endif()
