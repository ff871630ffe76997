# Libraries that more than one room uses. What is required is looked for here, or where it is used.
find_path(ERRBOUND_GMP_INCLUDE gmp.h)
find_library(ERRBOUND_GMP_LIBRARY gmp)
find_path(ERRBOUND_MPFR_INCLUDE mpfr.h)
find_library(ERRBOUND_MPFR_LIBRARY mpfr)
mark_as_advanced(ERRBOUND_GMP_INCLUDE ERRBOUND_GMP_LIBRARY ERRBOUND_MPFR_INCLUDE
                 ERRBOUND_MPFR_LIBRARY)

if(ERRBOUND_BUILD_CCD)
  find_package(Boost 1.74 REQUIRED)
  find_package(Threads REQUIRED)  # which the target of a static oneTBB names
  find_package(TBB REQUIRED)
  find_package(xsimd REQUIRED)
  if(ERRBOUND_BUILD_PROGRAM)
    find_package(CLI11 REQUIRED)
  endif()
  if(ERRBOUND_BUILD_PROGRAM OR ERRBOUND_BUILD_PYTHON)
    find_package(nlohmann_json REQUIRED)
  endif()
  if(ERRBOUND_WITH_CUDA)
    include(${CMAKE_CURRENT_LIST_DIR}/cuda.cmake)
  endif()
endif()
