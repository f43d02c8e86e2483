# Refuses flags that widen vectors to AVX. Eigen then aligns its memory to 32 bytes, by hand, while PCL and everything
# else from the distribution was built for 16: what one allocates the other frees at another address, and points passed
# between them lie elsewhere. The result is a segmentation fault in the first cloud that changes hands.
string(TOUPPER "${CMAKE_BUILD_TYPE}" vector_width_build)
set(vector_width_flags "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${vector_width_build}}")
string(REGEX MATCH "-march=native|-mavx[0-9a-z]*" vector_width_found "${vector_width_flags}")
if(NOT vector_width_found AND vector_width_flags MATCHES "-m(arch|cpu|tune)=")
  # another processor by name: the compiler knows whether that has AVX
  separate_arguments(vector_width_list UNIX_COMMAND "${vector_width_flags}")
  execute_process(COMMAND ${CMAKE_CXX_COMPILER} ${vector_width_list} -dM -E -x c++ /dev/null
    OUTPUT_VARIABLE vector_width_macros ERROR_QUIET)
  if(vector_width_macros MATCHES "#define __AVX__ ")
    string(REGEX MATCH "-march=[^ ]*" vector_width_found "${vector_width_flags}")
  endif()
endif()
if(vector_width_found)
  message(FATAL_ERROR "'${vector_width_found}' in CMAKE_CXX_FLAGS (or CXXFLAGS) makes Eigen align memory to 32 bytes, "
    "but PCL from the distribution was built for 16: programs that use both crash. Build without it (remove "
    "${CMAKE_BINARY_DIR}/CMakeCache.txt), or with -march=x86-64-v2, which has no AVX.")
endif()
