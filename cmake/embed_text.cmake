# Makes a C++ source of a text file: cmake -DINPUT=FILE -DOUTPUT=FILE -DNAME=a::b::name -P ...
file(READ ${INPUT} text)
string(FIND "${text}" ")embedded\"" delimiter)
if(NOT delimiter EQUAL -1)
  message(FATAL_ERROR "${INPUT}: found the end of the string that is to hold it")
endif()
string(REGEX REPLACE "::[^:]*$" "" namespace ${NAME})
string(REGEX REPLACE "^.*::" "" variable ${NAME})
file(WRITE ${OUTPUT} "// Generated from ${INPUT}.\n#include <string_view>\n\nnamespace ${namespace} {\nextern const std::string_view ${variable};\nconst std::string_view ${variable} = R\"embedded(${text})embedded\";\n}\n")
