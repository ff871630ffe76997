# How ./run everywhere compiles for a target: as the environment says, which run.py sets from targets.py.
# (try_compile reads this file again, without the caller's variables.)
set(triple $ENV{ERRBOUND_TRIPLE})
set(CMAKE_SYSTEM_NAME $ENV{ERRBOUND_SYSTEM})
set(CMAKE_SYSTEM_PROCESSOR $ENV{ERRBOUND_PROCESSOR})
set(CMAKE_C_COMPILER $ENV{ERRBOUND_CC})
set(CMAKE_CXX_COMPILER $ENV{ERRBOUND_CXX})
set(CMAKE_C_FLAGS_INIT "$ENV{ERRBOUND_FLAGS}")
set(CMAKE_CXX_FLAGS_INIT "$ENV{ERRBOUND_FLAGS} $ENV{ERRBOUND_CXX_FLAGS}")
set(CMAKE_CROSSCOMPILING_EMULATOR "$ENV{ERRBOUND_EMULATOR}")

# Nothing of the host but headers that are the same for all: its own libraries would be found, too.
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
set(xsimd_DIR "$ENV{ERRBOUND_HEADERS}/lib/host/cmake/xsimd")
