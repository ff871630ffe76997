# CPack runs this before it makes Debian packages. It adds copyright and changelog to each.
if(NOT CPACK_GENERATOR STREQUAL "DEB")
  return()
endif()
set(version ${CPACK_PACKAGE_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})
string(TIMESTAMP day "%a, %d %b %Y %H:%M:%S +0000" UTC)  # of SOURCE_DATE_EPOCH, if that is set
foreach(component programs development)
  set(staged ${CPACK_TEMPORARY_DIRECTORY}/${component})
  if(NOT IS_DIRECTORY ${staged})
    continue()
  endif()
  string(TOUPPER ${component} component)
  set(package ${CPACK_DEBIAN_${component}_PACKAGE_NAME})
  set(documents ${staged}/usr/share/doc/${package})
  file(MAKE_DIRECTORY ${documents})
  configure_file(${CPACK_RESOURCE_FILE_LICENSE} ${documents}/copyright COPYONLY)
  set(change ${CPACK_TEMPORARY_DIRECTORY}/changelog.Debian)
  file(WRITE ${change} "${package} (${version}) unstable; urgency=medium\n\n"
       "  * Made by CPack of errbound ${CPACK_PACKAGE_VERSION}, whose CHANGELOG.md says what changed.\n\n"
       " -- ${CPACK_PACKAGE_CONTACT}  ${day}\n")
  execute_process(COMMAND gzip -9n INPUT_FILE ${change} OUTPUT_FILE ${documents}/changelog.Debian.gz
                  COMMAND_ERROR_IS_FATAL ANY)
  file(REMOVE ${change})
endforeach()
