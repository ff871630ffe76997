# Build type, compiler cache, sanitizers and warnings.
if(PROJECT_IS_TOP_LEVEL AND NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

if(PROJECT_IS_TOP_LEVEL AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
  find_program(ERRBOUND_CCACHE ccache)
  mark_as_advanced(ERRBOUND_CCACHE)
  if(ERRBOUND_CCACHE)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${ERRBOUND_CCACHE})
    set(CMAKE_CUDA_COMPILER_LAUNCHER ${ERRBOUND_CCACHE})
  endif()
endif()

if(UNIX AND CMAKE_SIZEOF_VOID_P EQUAL 4)
  add_compile_definitions(_FILE_OFFSET_BITS=64)  # files of more than 2 GiB
endif()

if(ERRBOUND_SANITIZE)
  add_compile_options(-fsanitize=${ERRBOUND_SANITIZE} -fno-sanitize-recover=all
                      -fno-omit-frame-pointer -g1)
  add_link_options(-fsanitize=${ERRBOUND_SANITIZE})
  if(ERRBOUND_SANITIZE MATCHES "undefined")
    # The address sanitizer also detects these, or they cannot occur (no virtual functions, and pointers
    # to other types only in device code). With them, tests take four times as long to compile.
    add_compile_options(-fno-sanitize=null,vptr,object-size,alignment,nonnull-attribute)
    add_compile_options(-fno-sanitize=returns-nonnull-attribute)
  endif()
  set(ERRBOUND_WITH_CUDA OFF)  # sanitizers do not check it
  set(ERRBOUND_WITH_MPI OFF)   # sanitizers would report its leaks
endif()

# Warnings apply to the project's targets only. In another project, its warnings, which may be errors,
# are turned off here.
if(PROJECT_IS_TOP_LEVEL)
  add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:-Wall;-Wextra;-Wconversion>")
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION MATCHES "^12")
    # False alarms for "text" + std::string: GCC bug 105651.
    add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:-Wno-restrict>")
  endif()
  if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    # Masks of one lane are bool; & of them must evaluate both sides, as for many lanes.
    # GCC's -Wconversion excludes changes of sign.
    add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:-Wno-bitwise-instead-of-logical;-Wno-sign-conversion>")
  endif()
else()
  add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:-w>")
endif()
if(ERRBOUND_WERROR)
  add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:-Werror>")
endif()
