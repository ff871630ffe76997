# Toolchain of the wheels that run on any x86-64 Linux of the last ten years (manylinux2014): zig's clang and
# libc++, with the symbols of glibc 2.17. ERRBOUND_WHEEL_TOOLS is the folder that release.sh prepares: cc and
# c++, which call zig, cpuinfo.o and, in libraries/, oneTBB as a static library and the headers of Boost,
# xsimd and nlohmann-json alone (beside the system's own, its C library's headers would be found too).
set(tools $ENV{ERRBOUND_WHEEL_TOOLS})
set(CMAKE_C_COMPILER ${tools}/cc)
set(CMAKE_CXX_COMPILER ${tools}/c++)
set(CMAKE_LIBRARY_ARCHITECTURE x86_64-linux-gnu)
list(APPEND CMAKE_PREFIX_PATH ${tools}/libraries/usr)  # beside what scikit-build-core sets

# Boost 1.74 wants std::unary_function, nanobind 3.1 stderr without its header. Warnings are heeded
# where the project is built with its own compilers.
set(CMAKE_CXX_FLAGS_INIT
    "-D_LIBCPP_ENABLE_CXX17_REMOVED_UNARY_BINARY_FUNCTION -include cstdio -w")
# libgcc's answer to __builtin_cpu_supports: by zig's own no processor has anything, and the kernels for
# AVX2 and AVX-512 would never run (lib/compiler_rt/fmv.zig of 0.17: "a conservative stub").
set(CMAKE_MODULE_LINKER_FLAGS_INIT ${tools}/cpuinfo.o)
