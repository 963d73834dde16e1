# Read after project() (CMAKE_PROJECT_INCLUDE): the rooms that are mutated are compiled file by file.
cmake_language(DEFER CALL set_target_properties slideway_identify slideway_trace PROPERTIES UNITY_BUILD OFF)
