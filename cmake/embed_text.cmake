# errbound_embed_text(TARGET FILE NAME): adds the text of FILE to the target, as the string NAME = a::b::name. A
# script call writes the C++ source: cmake -DINPUT=FILE -DOUTPUT=FILE -DNAME=a::b::name -P ...
if(NOT CMAKE_SCRIPT_MODE_FILE)
  function(errbound_embed_text target file name)
    string(MAKE_C_IDENTIFIER ${name} source)
    set(source ${CMAKE_CURRENT_BINARY_DIR}/${source}.cpp)
    set(script ${PROJECT_SOURCE_DIR}/cmake/embed_text.cmake)
    add_custom_command(OUTPUT ${source} DEPENDS ${file} ${script}
      COMMAND ${CMAKE_COMMAND} -DINPUT=${CMAKE_CURRENT_SOURCE_DIR}/${file} -DOUTPUT=${source}
              -DNAME=${name} -P ${script} VERBATIM)
    target_sources(${target} PRIVATE ${source})
  endfunction()
  return()
endif()
file(READ ${INPUT} text)
string(FIND "${text}" ")embedded\"" delimiter)
if(NOT delimiter EQUAL -1)
  message(FATAL_ERROR "${INPUT} contains the delimiter of raw strings; expected a text without it")
endif()
string(REGEX REPLACE "::[^:]*$" "" namespace ${NAME})
string(REGEX REPLACE "^.*::" "" variable ${NAME})
file(WRITE ${OUTPUT} "// Generated from ${INPUT}.\n#include <string_view>\n\nnamespace ${namespace} {\nextern const std::string_view ${variable};\nconst std::string_view ${variable} = R\"embedded(${text})embedded\";\n}\n")
