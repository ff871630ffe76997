# How everything here is compiled: build type, sanitizers, warnings.
if(PROJECT_IS_TOP_LEVEL AND NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

if(ERRBOUND_SANITIZE)
  add_compile_options(-fsanitize=${ERRBOUND_SANITIZE} -fno-sanitize-recover=all
                      -fno-omit-frame-pointer -g)
  add_link_options(-fsanitize=${ERRBOUND_SANITIZE})
  set(ERRBOUND_WITH_CUDA OFF)  # of which sanitizers see nothing
endif()

# Warnings are for the project's own targets; users get none of them.
add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:-Wall;-Wextra;-Wconversion>")
