# Collision detection for CUDA devices: errbound::ccd_cuda, where there is an nvcc that knows C++20.
include(CheckLanguage)
check_language(CUDA)
if(NOT CMAKE_CUDA_COMPILER)
  message(STATUS "errbound: building without CUDA: no nvcc")
  return()
endif()
# Where nothing else is asked for: machine code for compute capability 8 and 9, and PTX, which drivers
# compile for 7.5 and all later ones; all by one pass of the compiler proper, since nothing of the
# newer instruction sets would be used.
if(NOT DEFINED CMAKE_CUDA_ARCHITECTURES)
  set(CMAKE_CUDA_ARCHITECTURES OFF)
  foreach(code sm_80 sm_90 compute_75)
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
# tests/cuda/flags_test.sh shows what becomes of the code otherwise.
set(errbound_cuda_precision -fmad=false -ftz=false -prec-div=true -prec-sqrt=true)
# (The standard as an option: CMake 3.25 does not know nvcc 13's.)
set(errbound_cuda_options ${errbound_cuda_targets} -std=c++20 --expt-relaxed-constexpr
                          ${errbound_cuda_precision} -Xcompiler=-ffp-contract=off,-Wall)

function(errbound_cuda_library name)
  cmake_parse_arguments(arg "" "" "SOURCES;DEFINITIONS" ${ARGN})
  add_library(${name} OBJECT ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE errbound CUDA::cudart_static)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_compile_definitions(${name} PRIVATE ${arg_DEFINITIONS})
  target_compile_options(${name} PRIVATE ${errbound_cuda_options})
  set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_sources(errbound_ccd_cuda PRIVATE $<TARGET_OBJECTS:${name}>)
endfunction()

add_library(errbound_ccd_cuda STATIC)
add_library(errbound::ccd_cuda ALIAS errbound_ccd_cuda)
set_target_properties(errbound_ccd_cuda PROPERTIES EXPORT_NAME ccd_cuda LINKER_LANGUAGE CXX)
target_link_libraries(errbound_ccd_cuda PUBLIC errbound_ccd PRIVATE CUDA::cudart_static)
errbound_cuda_library(errbound_cuda_batch SOURCES ccd/cuda/batch.cu ccd/cuda/sort.cu
  ccd/cuda/step.cu)
foreach(kind vertex_face edge_edge)
  errbound_cuda_library(errbound_cuda_exact_${kind} SOURCES ccd/cuda/exact.cu
    DEFINITIONS ERRBOUND_INDICES=${kind}_indices)
endforeach()
function(errbound_cuda_method name type)
  errbound_cuda_library(errbound_cuda_${name} SOURCES ccd/cuda/method.cu
    DEFINITIONS ERRBOUND_METHOD=device_${name} "ERRBOUND_METHOD_TYPE=${type}")
endfunction()
errbound_cuda_method(float "bsc_method<errbound::none>")
errbound_cuda_method(safe "bsc_method<errbound::safe>")
errbound_cuda_method(tight "bsc_method<errbound::tight>")
errbound_cuda_method(safeccd "safeccd_method<errbound::safe>")
errbound_cuda_method(safeccd_tight "safeccd_method<errbound::tight>")

install(TARGETS errbound_ccd_cuda EXPORT errbound_ccd_cuda_targets)
install(EXPORT errbound_ccd_cuda_targets NAMESPACE errbound::
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/errbound)
