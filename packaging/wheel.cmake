# The toolchain of wheels for any x86-64 Linux of the last ten years (manylinux2014): zig's clang and libc++, with
# symbols of glibc 2.17. release.sh prepares the folder ERRBOUND_WHEEL_TOOLS: cc and c++, which call zig, and cpuinfo.o.
# Its folder libraries/ has a static oneTBB and headers of Boost, xsimd and nlohmann-json. They are copies, since the
# system's folder also has headers of its C library.
set(tools $ENV{ERRBOUND_WHEEL_TOOLS})
set(CMAKE_C_COMPILER ${tools}/cc)
set(CMAKE_CXX_COMPILER ${tools}/c++)
set(CMAKE_LIBRARY_ARCHITECTURE x86_64-linux-gnu)
list(APPEND CMAKE_PREFIX_PATH ${tools}/libraries/usr)  # beside what scikit-build-core sets

# Boost 1.74 needs std::unary_function, nanobind 3.1 needs stderr without its header. Other builds check warnings.
set(CMAKE_CXX_FLAGS_INIT
    "-D_LIBCPP_ENABLE_CXX17_REMOVED_UNARY_BINARY_FUNCTION -include cstdio -w")
# libgcc's __builtin_cpu_supports: zig's reports no feature of any processor, so that the kernels for AVX2 and AVX-512
# would never run (lib/compiler_rt/fmv.zig of 0.17: "a conservative stub").
set(CMAKE_MODULE_LINKER_FLAGS_INIT ${tools}/cpuinfo.o)
