# Libraries that more than one room uses. What is required is looked for here, or where it is used.
find_path(ERRBOUND_GMP_INCLUDE gmp.h)
find_library(ERRBOUND_GMP_LIBRARY gmp)
find_path(ERRBOUND_MPFR_INCLUDE mpfr.h)
find_library(ERRBOUND_MPFR_LIBRARY mpfr)
# The library alone: CMake's own module would link what a static one needs, too.
find_path(ERRBOUND_HDF5_INCLUDE hdf5.h PATH_SUFFIXES hdf5/serial)
find_library(ERRBOUND_HDF5_LIBRARY NAMES hdf5_serial hdf5)
mark_as_advanced(ERRBOUND_HDF5_INCLUDE ERRBOUND_HDF5_LIBRARY)
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
  if(ERRBOUND_WITH_MPI)
    set(MPI_CXX_SKIP_MPICXX ON)  # the C interface alone
    find_package(MPI 3.0 COMPONENTS CXX)
    if(NOT MPI_CXX_FOUND)
      message(STATUS "errbound: no MPI; errbound::ccd_mpi is left out")
    endif()
  endif()
  if(ERRBOUND_WITH_CUDA)
    include(${CMAKE_CURRENT_LIST_DIR}/cuda.cmake)
  endif()
endif()
