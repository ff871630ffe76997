# The target `mpfi`, interval arithmetic over MPFR, if installed (libmpfi-dev).
include_guard(DIRECTORY)
find_path(ERRBOUND_MPFI_INCLUDE mpfi.h)
find_library(ERRBOUND_MPFI_LIBRARY mpfi)
mark_as_advanced(ERRBOUND_MPFI_INCLUDE ERRBOUND_MPFI_LIBRARY)
if(ERRBOUND_MPFI_INCLUDE AND ERRBOUND_MPFI_LIBRARY AND ERRBOUND_MPFR_LIBRARY AND
   ERRBOUND_GMP_INCLUDE AND ERRBOUND_GMP_LIBRARY AND NOT TARGET mpfi)
  add_library(mpfi INTERFACE)
  target_link_libraries(mpfi INTERFACE ${ERRBOUND_MPFI_LIBRARY} ${ERRBOUND_MPFR_LIBRARY}
                                       ${ERRBOUND_GMP_LIBRARY})
  target_include_directories(mpfi SYSTEM INTERFACE ${ERRBOUND_MPFI_INCLUDE} ${ERRBOUND_MPFR_INCLUDE}
                                                   ${ERRBOUND_GMP_INCLUDE})
  target_compile_definitions(mpfi INTERFACE ERRBOUND_HAVE_MPFI)
endif()
