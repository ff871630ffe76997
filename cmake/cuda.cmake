# Looks for nvcc, and says how device code is compiled: where it is found, errbound_cuda_options is set.
include(CheckLanguage)
check_language(CUDA)
if(NOT CMAKE_CUDA_COMPILER)
  message(STATUS "errbound: building without CUDA: no nvcc")
  return()
endif()
# Where nothing else is asked for: machine code for compute capability 8 and 9, and PTX, which drivers
# compile for 7.5 and all later ones; all by one pass of the compiler proper, since nothing of the
# newer instruction sets would be used. Each machine takes minutes.
set(ERRBOUND_CUDA_CODES sm_80 sm_90 compute_75 CACHE STRING
    "What device code is compiled for, where CMAKE_CUDA_ARCHITECTURES does not say")
if(NOT DEFINED CMAKE_CUDA_ARCHITECTURES)
  set(CMAKE_CUDA_ARCHITECTURES OFF)
  foreach(code IN LISTS ERRBOUND_CUDA_CODES)
    list(APPEND errbound_cuda_targets "SHELL:-gencode arch=compute_75,code=${code}")
  endforeach()
endif()
enable_language(CUDA)
if(CMAKE_CUDA_COMPILER_VERSION VERSION_LESS 12.0)
  message(STATUS "errbound: building without CUDA: nvcc ${CMAKE_CUDA_COMPILER_VERSION} is older "
                 "than 12.0")
  return()
endif()
find_package(CUDAToolkit QUIET)
if(NOT TARGET CUDA::cudart_static)
  message(STATUS "errbound: building without CUDA: nvcc is there, but not the toolkit's libraries")
  return()
endif()

# What bounds and identical answers need of device code: no contraction to fused multiply-add, no
# flushing of subnormals, divisions and square roots that are rounded correctly.
# tests/ccd/cuda/flags_test.sh shows what becomes of the code otherwise.
set(errbound_cuda_precision -fmad=false -ftz=false -prec-div=true -prec-sqrt=true)
# (The standard as an option: CMake 3.25 does not know nvcc 13's.)
set(errbound_cuda_options ${errbound_cuda_targets} -std=c++20 --expt-relaxed-constexpr
                          ${errbound_cuda_precision} -Xcompiler=-ffp-contract=off,-Wall)
# Tests read the PTX of the objects (tests/ccd/cuda/emulator).
if(ERRBOUND_EMULATE_CUDA)
  list(APPEND errbound_cuda_options --no-compress)
endif()
