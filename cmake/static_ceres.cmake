# Ceres with what it needs as static libraries where Debian has them: two dozen shared ones cost the
# loader more time than a profile of 20,000 samples costs the program. Else everything stays shared.
include(CheckCXXSourceCompiles)

set(parts "")
foreach(name IN ITEMS glog gflags cholmod amd camd ccolamd colamd suitesparseconfig cxsparse
                      lapack f77blas cblas atlas)
  find_library(SLIDEWAY_${name}_ARCHIVE lib${name}.a)
  mark_as_advanced(SLIDEWAY_${name}_ARCHIVE)
  list(APPEND parts "${SLIDEWAY_${name}_ARCHIVE}")
endforeach()
foreach(name IN ITEMS gfortran gomp)  # the compiler knows where
  list(APPEND parts "-l:lib${name}.a")
endforeach()
find_library(SLIDEWAY_metis libmetis.so.5)  # not to be had as a static one, no more than unwind
mark_as_advanced(SLIDEWAY_metis)
# Both gcc_s and unwind unwind for exceptions, and the first does it for all: unwind needs two free
# file descriptors, and the program ends by a signal where there are none.
list(APPEND parts "${SLIDEWAY_metis}" gcc_s)
if(CMAKE_SYSTEM_PROCESSOR STREQUAL x86_64)  # Debian's glog and Fortran do without on arm64
  list(APPEND parts unwind -l:libquadmath.a)
endif()
list(APPEND parts Threads::Threads)

if(NOT "${parts}" MATCHES NOTFOUND)
  get_target_property(archive Ceres::ceres LOCATION)
  set(CMAKE_REQUIRED_LIBRARIES ${archive} ${parts} Eigen3::Eigen)
  get_target_property(CMAKE_REQUIRED_INCLUDES Ceres::ceres INTERFACE_INCLUDE_DIRECTORIES)
  check_cxx_source_compiles("
    #include <ceres/problem.h>
    #include <ceres/solver.h>
    int main() {
      ceres::Problem problem;
      ceres::Solver::Summary summary;
      ceres::Solve({}, &problem, &summary);
    }" SLIDEWAY_STATIC_CERES)
  unset(CMAKE_REQUIRED_LIBRARIES)
  unset(CMAKE_REQUIRED_INCLUDES)
endif()
if(SLIDEWAY_STATIC_CERES)  # of programs only: gomp and gfortran do not go into a module
  get_target_property(shared Ceres::ceres INTERFACE_LINK_LIBRARIES)
  set_target_properties(Ceres::ceres PROPERTIES INTERFACE_LINK_LIBRARIES
    "$<IF:$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>,${parts},${shared}>;Eigen3::Eigen")
endif()
