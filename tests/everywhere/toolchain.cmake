# The toolchain of ./run everywhere. run.py sets the environment from targets.py, since try_compile reads this file
# without the caller's variables.
set(triple $ENV{ERRBOUND_TRIPLE})
set(CMAKE_SYSTEM_NAME $ENV{ERRBOUND_SYSTEM})
set(CMAKE_SYSTEM_PROCESSOR $ENV{ERRBOUND_PROCESSOR})
set(CMAKE_C_COMPILER $ENV{ERRBOUND_CC})
set(CMAKE_CXX_COMPILER $ENV{ERRBOUND_CXX})
if(NOT "$ENV{ERRBOUND_AR}" STREQUAL "")
  set(CMAKE_AR $ENV{ERRBOUND_AR})
  set(CMAKE_RANLIB $ENV{ERRBOUND_RANLIB})
endif()
set(CMAKE_C_FLAGS_INIT "$ENV{ERRBOUND_FLAGS}")
set(CMAKE_CXX_FLAGS_INIT "$ENV{ERRBOUND_FLAGS} $ENV{ERRBOUND_CXX_FLAGS}")
set(CMAKE_CROSSCOMPILING_EMULATOR "$ENV{ERRBOUND_EMULATOR}")

# Only headers that are equal for all targets come from the host, so that its libraries are not found.
set(CMAKE_PREFIX_PATH /)
set(CMAKE_FIND_ROOT_PATH "$ENV{ERRBOUND_LIBRARIES}" "$ENV{ERRBOUND_HEADERS}")
if(triple)
  list(APPEND CMAKE_FIND_ROOT_PATH /usr/${triple})
endif()
foreach(kind LIBRARY INCLUDE PACKAGE)
  set(CMAKE_FIND_ROOT_PATH_MODE_${kind} ONLY)
endforeach()
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(Boost_NO_BOOST_CMAKE ON)  # whose files name the host's folders
if(EXISTS "$ENV{ERRBOUND_HEADERS}/lib/host/cmake/xsimd")
  set(xsimd_DIR "$ENV{ERRBOUND_HEADERS}/lib/host/cmake/xsimd")
endif()
