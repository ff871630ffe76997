# If installed, the targets `flint`, with GMP and headers (libflint-dev), and `arb`, its ball arithmetic
# (libflint-arb-dev).
include_guard(DIRECTORY)
find_path(ERRBOUND_FLINT_INCLUDE flint/fmpz_poly.h)
find_library(ERRBOUND_FLINT_LIBRARY flint)
mark_as_advanced(ERRBOUND_FLINT_INCLUDE ERRBOUND_FLINT_LIBRARY)
if(ERRBOUND_FLINT_INCLUDE AND ERRBOUND_FLINT_LIBRARY AND ERRBOUND_GMP_INCLUDE AND
   ERRBOUND_GMP_LIBRARY AND NOT TARGET flint)
  add_library(flint INTERFACE)
  target_link_libraries(flint INTERFACE errbound Boost::headers ${ERRBOUND_FLINT_LIBRARY}
                                        ${ERRBOUND_GMP_LIBRARY})
  target_include_directories(flint SYSTEM INTERFACE ${ERRBOUND_FLINT_INCLUDE}
                                                    ${ERRBOUND_GMP_INCLUDE})
  target_compile_options(flint INTERFACE -ffp-contract=off)
endif()
find_path(ERRBOUND_ARB_INCLUDE arb_fmpz_poly.h)
find_library(ERRBOUND_ARB_LIBRARY NAMES flint-arb arb)
mark_as_advanced(ERRBOUND_ARB_INCLUDE ERRBOUND_ARB_LIBRARY)
if(TARGET flint AND ERRBOUND_ARB_INCLUDE AND ERRBOUND_ARB_LIBRARY AND NOT TARGET arb)
  add_library(arb INTERFACE)
  target_link_libraries(arb INTERFACE ${ERRBOUND_ARB_LIBRARY} flint)
  target_include_directories(arb SYSTEM INTERFACE ${ERRBOUND_ARB_INCLUDE})
  target_compile_definitions(arb INTERFACE ERRBOUND_HAS_ARB)
endif()
