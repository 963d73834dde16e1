# cmake -D ROOT=<repository> -P cmake/check_layers.cmake
#
# Reads every include line under include/slideway/<room> and src/<room>: a room may include itself
# and the rooms before it, and a library stays in the rooms that own it. Also: no file above
# MAX_LINES, no header without #pragma once, docs/architecture.md draws the rooms in this order, and
# no effect named in a string outside the effects' own files (src/effects/terms, which name those
# they are confounded with): what an effect is, is asked of the effect. Every breach is printed; one
# or more is a failure.
cmake_minimum_required(VERSION 3.25)
set(ROOMS base format machine signal profile effects identify trace report batch serve python cli)
set(MAX_LINES 400)
# A library and the rooms whose sources (never public headers) may include it.
set(LIBRARIES "ceres/" "nlohmann/" "toml\\+\\+/" "pugixml\\.hpp" "zip\\.h" "pybind11/" "mpi\\.h"
    "boost/math/" "fast_float/" "muParser" "httplib\\.h")
set(OWNERS "identify trace" "report batch serve cli" "identify" "format report" "format" "python" "batch"
    "base signal" "format" "effects" "serve")

# Strings that are a key of the report or a plain word and not the effect of that name: file:name.
set(NOT_AN_EFFECT
    # crosscheck.squareness and straightness, keys of the report, and a place on the page
    include/slideway/identify/result_fields.hpp:squareness
    include/slideway/identify/result_fields.hpp:straightness
    src/report/html_pictures.cpp:straightness
    src/report/html_brief.cpp:squareness src/report/html_brief.cpp:straightness
    src/serve/results_view.cpp:squareness src/serve/results_view.cpp:straightness
    # [tolerance], what is held against a limit
    src/identify/conformity.cpp:squareness src/identify/conformity.cpp:straightness
    # `export --step`, and the label of a step in position
    src/cli/command_export.cpp:step src/cli/command_info.cpp:step)

# The registration list of the effects. Names without an underscore are plain words of the field
# too, and are free in prose: in a string with a blank.
set(effects "")
if(EXISTS ${ROOT}/src/effects/CMakeLists.txt)
  file(READ ${ROOT}/src/effects/CMakeLists.txt registered)
  string(REGEX MATCH "SLIDEWAY_EFFECTS([^)]*)" registered "${registered}")
  string(REGEX MATCHALL "[a-z_]+" effects "${CMAKE_MATCH_1}")
endif()
set(compounds ${effects})
list(FILTER compounds INCLUDE REGEX "_")
list(JOIN effects "|" effects)
list(JOIN compounds "|" compounds)

set(breaches 0)
function(breach text)
  message(NOTICE "${text}")
  math(EXPR breaches "${breaches} + 1")
  set(breaches ${breaches} PARENT_SCOPE)
endfunction()

macro(check_room_include file room target)
  list(FIND ROOMS "${target}" target_index)
  list(FIND ROOMS "${room}" room_index)
  if(target_index EQUAL -1)
    breach("${file}: includes slideway/${target}, which is no room; rooms: ${ROOMS}")
  elseif(target_index GREATER room_index)
    breach("${file}: ${room} may not include ${target}, a later room")
  endif()
endmacro()

macro(check_library_include file room line)
  foreach(library owners IN ZIP_LISTS LIBRARIES OWNERS)
    if("${line}" MATCHES "[<\"](${library})")
      set(name ${CMAKE_MATCH_1})
      string(REPLACE " " ";" owners "${owners}")
      if(NOT "${room}" IN_LIST owners OR "${file}" MATCHES "^include/")
        breach("${file}: ${name} belongs in the sources of: ${owners}")
      endif()
    endif()
  endforeach()
endmacro()

string(JOIN "` ← `" drawing ${ROOMS})
file(STRINGS ${ROOT}/docs/architecture.md lines ENCODING UTF-8)
if(NOT "`${drawing}`" IN_LIST lines)
  breach("docs/architecture.md: has no line `${drawing}`")
endif()
# Of `contents`.
macro(check_effect_names file)
  string(REGEX REPLACE "//[^\n]*|#[ \t]*include[^\n]*" "" code "${contents}")
  string(REGEX REPLACE "[][;]" " , " code "${code}")  # what a list of CMake would stumble over
  string(REGEX MATCHALL "\"([^\"\\\n]|\\\\[^\n])*\"" literals "${code}")
  foreach(literal IN LISTS literals)
    set(names "${effects}")
    if(literal MATCHES " ")
      set(names "${compounds}")
    endif()
    if(literal MATCHES "[^A-Za-z0-9_](${names})[^A-Za-z0-9_]")
      set(name ${CMAKE_MATCH_1})
      if(NOT "${file}:${name}" IN_LIST NOT_AN_EFFECT)
        breach("${file}: ${literal} names the effect ${name}; ask the effect instead")
      endif()
    endif()
  endforeach()
endmacro()

file(GLOB_RECURSE files RELATIVE ${ROOT} ${ROOT}/include/*.hpp ${ROOT}/src/*.hpp ${ROOT}/src/*.cpp)
if(NOT files)
  message(FATAL_ERROR "no sources under ${ROOT}")
endif()
foreach(file IN LISTS files)
  string(REGEX REPLACE "^(include/slideway|include|src)/([^/]*).*" "\\2" room ${file})
  if(NOT room IN_LIST ROOMS)
    breach("${file}: ${room} is no room; rooms: ${ROOMS}")
    continue()
  endif()

  file(STRINGS ${ROOT}/${file} includes REGEX "^[ \t]*#[ \t]*include")
  foreach(line IN LISTS includes)
    if(line MATCHES "[<\"]slideway/([^/>\"]*)")
      check_room_include(${file} ${room} ${CMAKE_MATCH_1})
    endif()
    check_library_include(${file} ${room} "${line}")
  endforeach()

  file(READ ${ROOT}/${file} contents)
  if(file MATCHES "\\.hpp$" AND NOT contents MATCHES "(^|\n)#pragma once\n")
    breach("${file}: no #pragma once")
  endif()
  if(effects AND NOT file MATCHES "^src/effects/terms/")
    check_effect_names(${file})
  endif()
  string(REGEX MATCHALL "\n" newlines "${contents}")
  list(LENGTH newlines lines)
  if(lines GREATER MAX_LINES)
    breach("${file}: ${lines} lines, more than ${MAX_LINES}: split it")
  endif()
endforeach()

if(breaches GREATER 0)
  message(FATAL_ERROR "layers: ${breaches} breaches")
endif()
