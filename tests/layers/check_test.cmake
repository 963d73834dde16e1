# Runs the layer check over made-up trees of one file and looks at what it says.
cmake_minimum_required(VERSION 3.25)

# expect(path contents message): the check fails with that message; an empty one: it passes.
function(expect path contents message)
  file(REMOVE_RECURSE ${TREE})
  file(WRITE ${TREE}/${path} "${contents}")
  execute_process(COMMAND ${CMAKE_COMMAND} -D ROOT=${TREE} -P ${CHECK}
                  RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(message STREQUAL "" AND NOT status EQUAL 0)
    message(FATAL_ERROR "${path}: refused\n${output}")
  elseif(NOT message STREQUAL "" AND (status EQUAL 0 OR NOT output MATCHES "${message}"))
    message(FATAL_ERROR "${path}: '${message}' was not said, exit ${status}\n${output}")
  endif()
endfunction()

set(once "#pragma once\n")
set(machine "#include \"slideway/machine/machine.hpp\"\n")
expect(src/signal/a.cpp "${machine}" "")
expect(src/machine/a.cpp "${machine}" "")
expect(src/base/a.cpp "${machine}" "base may not include machine")
expect(include/slideway/base/a.hpp "${once}  #  include <slideway/cli/x.hpp>\n"
       "base may not include cli")
expect(src/effects/terms/a.cpp "#include \"slideway/identify/x.hpp\"\n"
       "effects may not include identify")
expect(src/cli/a.cpp "#include \"slideway/attic/x.hpp\"\n" "attic, which is no room")
expect(src/attic/a.cpp "\n" "attic is no room")
expect(include/slideway/a.hpp "${once}" "a.hpp is no room")
expect(include/slideway/base/a.hpp "// no guard\n" "no #pragma once")
expect(src/identify/a.cpp "#include <ceres/ceres.h>\n#include <toml++/toml.h>\n" "")
expect(src/report/a.cpp "#include <ceres/ceres.h>\n" "ceres/ belongs in the sources of")
expect(src/cli/a.cpp "#include <toml++/toml.h>\n" "toml\\+\\+/ belongs in the sources of")
expect(src/cli/a.cpp "#include <nlohmann/json.hpp>\n" "")
expect(src/cli/a.cpp "#include <pybind11/pybind11.h>\n" "pybind11/ belongs in the sources of")
expect(include/slideway/report/a.hpp "${once}#include <nlohmann/json.hpp>\n"
       "nlohmann/ belongs in the sources of")
string(REPEAT "\n" 400 long)
expect(src/base/a.cpp "${long}" "")
expect(src/base/a.cpp "${long}\n" "401 lines")
file(REMOVE_RECURSE ${TREE})
