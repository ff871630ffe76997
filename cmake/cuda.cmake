# Looks for nvcc. If found, sets errbound_cuda_options, the options for device code.
include(CheckLanguage)
check_language(CUDA)
if(NOT CMAKE_CUDA_COMPILER)
  message(STATUS "errbound: building without CUDA: no nvcc")
  return()
endif()
# The default: machine code for compute capability 8 and 9, and PTX, which drivers compile for 7.5 and
# all later ones. One compiler pass serves all, since newer instructions would not be used. Each machine
# takes minutes.
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

# Bounds and identical answers require: no contraction to fused multiply-add, no flushing of subnormals,
# correctly rounded divisions and square roots (tests/ccd/cuda/flags_test.sh).
set(errbound_cuda_precision -fmad=false -ftz=false -prec-div=true -prec-sqrt=true)
# The standard is an option, since CMake 3.25 does not support that of nvcc 13.
set(errbound_cuda_options ${errbound_cuda_targets} -std=c++20 --expt-relaxed-constexpr
                          ${errbound_cuda_precision} -Xcompiler=-ffp-contract=off,-Wall)
# Tests read the PTX of the objects (tests/ccd/cuda/emulator).
if(ERRBOUND_EMULATE_CUDA)
  list(APPEND errbound_cuda_options --no-compress)
endif()
