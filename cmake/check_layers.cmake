# cmake -D ROOT=<repository> -P cmake/check_layers.cmake
#
# Reads every include line under include/slideway/<room> and src/<room>: a room may include itself
# and the rooms before it, and a library stays in the rooms that own it. Also: no file above
# MAX_LINES, no header without #pragma once, and docs/architecture.md draws the rooms in this order.
# Every breach is printed; one or more is a failure.
cmake_minimum_required(VERSION 3.25)
set(ROOMS base format machine signal profile effects identify trace report batch python cli)
set(MAX_LINES 400)
# A library and the rooms whose sources (never public headers) may include it.
set(LIBRARIES "ceres/" "nlohmann/" "toml\\+\\+/" "pugixml\\.hpp" "zip\\.h" "pybind11/" "mpi\\.h"
    "boost/math/" "fast_float/")
set(OWNERS "identify trace" "report batch cli" "identify" "format" "format" "python" "batch"
    "base signal" "format")

set(breaches 0)
macro(breach text)
  message(NOTICE "${text}")
  math(EXPR breaches "${breaches} + 1")
endmacro()

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
  string(REGEX MATCHALL "\n" newlines "${contents}")
  list(LENGTH newlines lines)
  if(lines GREATER MAX_LINES)
    breach("${file}: ${lines} lines, more than ${MAX_LINES}: split it")
  endif()
endforeach()

if(breaches GREATER 0)
  message(FATAL_ERROR "layers: ${breaches} breaches")
endif()
