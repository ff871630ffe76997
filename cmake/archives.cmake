# `cpack` makes two Debian packages, errbound (programs) and liberrbound-dev (development), or archives without dpkg.
# `cpack --config CPackSourceConfig.cmake` makes the source archive. ./run release does both from a clean tree.
set(CPACK_PACKAGE_NAME errbound)
set(CPACK_PACKAGE_VENDOR "errbound authors")
set(ERRBOUND_MAINTAINER "errbound authors <errbound@localhost>" CACHE STRING
    "Whom Debian packages name: a name and an address")
mark_as_advanced(ERRBOUND_MAINTAINER)
set(CPACK_PACKAGE_CONTACT ${ERRBOUND_MAINTAINER})
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL development)
if(TARGET ccd_program)
  list(PREPEND CPACK_COMPONENTS_ALL programs)
endif()
set(CPACK_SOURCE_GENERATOR TXZ)
set(CPACK_SOURCE_PACKAGE_FILE_NAME errbound-${PROJECT_VERSION})
set(CPACK_VERBATIM_VARIABLES ON)
string(REGEX REPLACE "([][+.*()^$?|\\])" "\\\\\\1" source_folder "${PROJECT_SOURCE_DIR}")
set(CPACK_SOURCE_IGNORE_FILES "^${source_folder}/(\\.git|build[^/]*|out)/" "\\.pyc$")

find_program(ERRBOUND_DPKG dpkg)
mark_as_advanced(ERRBOUND_DPKG)
set(CPACK_GENERATOR TGZ)
if(ERRBOUND_DPKG)
  set(CPACK_GENERATOR DEB)
endif()
set(CPACK_ARCHIVE_COMPONENT_INSTALL ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SECTION math)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_NAME errbound)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAMS_DESCRIPTION
"The programs. ccd decides whether and when vertices, edges and faces in motion
touch, of stored queries and of whole meshes, without an error of rounding;
errbound validates bounds on rounding errors against MPFR.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME liberrbound-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION
"C++ headers for arithmetic that knows its rounding error and for predicates
with the right sign, and libraries for exact continuous collision detection,
for CMake's find_package(errbound).")
# Dependencies of the static libraries and the package's CMake files.
set(development_needs)
if(TARGET errbound_ccd)
  list(APPEND development_needs libtbb-dev)
endif()
if(TARGET errbound_ccd_io AND errbound_has_query_stores)
  list(APPEND development_needs libhdf5-dev)
endif()
if(TARGET errbound_validation)
  list(APPEND development_needs libmpfr-dev)
endif()
list(JOIN development_needs ", " CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS "errbound, libboost-dev, libeigen3-dev")
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/debian_documents.cmake)
include(CPack)
