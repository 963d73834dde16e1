# The way of a user of the library: install, find_package, build, run. docs/library.md shows the program and
# what it says.
cmake_minimum_required(VERSION 3.25)

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE out ERROR_VARIABLE out)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${ARGN}: exit ${status}\n${out}")
  endif()
  set(out "${out}" PARENT_SCOPE)
endfunction()

function(expect_in file text)
  file(READ ${file} contents)
  string(FIND "${contents}" "${text}" at)
  if(at EQUAL -1)
    message(FATAL_ERROR "${file} does not have\n${text}")
  endif()
endfunction()

file(REMOVE_RECURSE ${OUT})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${OUT}/first)
file(RENAME ${OUT}/first ${OUT}/prefix)  # an installed tree may move
file(GLOB_RECURSE targets ${OUT}/prefix/slidewayTargets*.cmake)
if(NOT targets)
  message(FATAL_ERROR "no slidewayTargets.cmake was installed")
endif()
foreach(file IN LISTS targets)
  file(READ ${file} contents)
  if(contents MATCHES "-W[a-z]|${SOURCE}|${BUILD}|${OUT}")
    message(FATAL_ERROR "${file} has what concerns nobody but the build: ${CMAKE_MATCH_0}")
  endif()
endforeach()

run(${CMAKE_COMMAND} -G ${GENERATOR} -S ${SOURCE}/tests/package/consumer -B ${OUT}/build
    -D CMAKE_CXX_COMPILER=${CXX} -D CMAKE_PREFIX_PATH=${OUT}/prefix)
run(${CMAKE_COMMAND} --build ${OUT}/build)
set(problem ${OUT}/prefix/share/doc/slideway/examples/problems/three-levels/problem.toml)
run(${OUT}/build/errors ${problem})

expect_in(${SOURCE}/docs/library.md "\n```text\n${out}```\n")
file(READ ${SOURCE}/tests/package/consumer/errors.cpp shown)
expect_in(${SOURCE}/docs/library.md "\n```cpp\n${shown}```\n")
file(READ ${SOURCE}/tests/package/consumer/CMakeLists.txt shown)
expect_in(${SOURCE}/docs/library.md "\n```cmake\n${shown}```\n")

run(${CMAKE_COMMAND} -G ${GENERATOR} -S ${SOURCE}/tests/package/own_effect -B ${OUT}/own_effect
    -D CMAKE_CXX_COMPILER=${CXX} -D CMAKE_PREFIX_PATH=${OUT}/prefix)
run(${CMAKE_COMMAND} --build ${OUT}/own_effect)
run(${OUT}/own_effect/own_effect ${problem})
if(NOT out MATCHES "^rack_teeth.amplitude_um = (0\\.4[89]|0\\.5[01]?)")
  message(FATAL_ERROR "own_effect: 0.5 µm of rack_teeth became ${out}")
endif()

run(${OUT}/prefix/bin/slideway --version)
if(NOT out STREQUAL "slideway ${VERSION}\n")
  message(FATAL_ERROR "--version: ${out}")
endif()

# The Debian package of the same tree; ./dev package tries one in a Debian of its own.
find_program(shlibdeps dpkg-shlibdeps)
if(shlibdeps)
  run(${CPACK} --config ${BUILD}/CPackConfig.cmake -B ${OUT}/package
      -D CPACK_PACKAGING_INSTALL_PREFIX=/usr)
  file(GLOB package ${OUT}/package/slideway_${VERSION}*.deb)
  run(dpkg-deb -x ${package} ${OUT}/root)
  run(${OUT}/root/usr/bin/slideway --version)
  if(NOT out STREQUAL "slideway ${VERSION}\n")
    message(FATAL_ERROR "--version of the package: ${out}")
  endif()
  # Every library it loads stands in the table of third parts, but for the C library.
  file(READ ${SOURCE}/THIRD_PARTY.md parts)
  run(ldd ${OUT}/root/usr/bin/slideway)
  string(REGEX MATCHALL "=> /[^ ]+" libraries "${out}")
  foreach(library IN LISTS libraries)
    string(REPLACE "=> " "*" library ${library})  # in /lib or in /usr/lib
    run(dpkg-query -S ${library})
    string(REGEX MATCH "^[^:,]+" part "${out}")
    string(FIND "${parts}" "| ${part} |" at)
    if(at EQUAL -1 AND NOT part MATCHES "^lib(c6|gcc-s1)$")
      message(FATAL_ERROR "THIRD_PARTY.md lacks ${part}, whose ${library} the program loads")
    endif()
  endforeach()
  run(${CMAKE_COMMAND} -D READELF=${READELF} -D PROGRAM=${OUT}/root/usr/bin/slideway
      -P ${CMAKE_CURRENT_LIST_DIR}/hardened.cmake)
endif()

file(STRINGS ${SOURCE}/CHANGELOG.md versions REGEX "^## \\[")
list(GET versions 0 newest)
if(NOT newest MATCHES "^## \\[${VERSION}\\]")
  message(FATAL_ERROR "CHANGELOG.md begins with ${newest}, the version is ${VERSION}")
endif()
