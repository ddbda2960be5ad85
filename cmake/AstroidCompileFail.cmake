# astroid_add_compile_fail_test(<label> LIBRARIES <libs> SOURCES <files>)
#   For each source a ctest <label>.compile_fail.<name>: it must compile with ASTROID_ALLOWED defined, and must not without, with an
#   error that matches the regular expression of its line "// error: ...". The control run keeps a typo from passing as a refusal.

if(CMAKE_SCRIPT_MODE_FILE)  # the test itself: cmake -DSOURCE=... -P this file -- compiler and flags
  foreach(index RANGE 1 ${CMAKE_ARGC})
    if("${CMAKE_ARGV${index}}" STREQUAL "--")
      set(begin ${index})
      break()
    endif()
  endforeach()
  math(EXPR begin "${begin} + 1")
  math(EXPR end "${CMAKE_ARGC} - 1")
  foreach(index RANGE ${begin} ${end})
    list(APPEND compile "${CMAKE_ARGV${index}}")
  endforeach()

  file(STRINGS ${SOURCE} expected REGEX "^// error: ")
  list(LENGTH expected lines)
  if(NOT lines EQUAL 1)
    message(FATAL_ERROR "${SOURCE}: wants exactly one line '// error: <regular expression>'")
  endif()
  string(REGEX REPLACE "^// error: " "" expected "${expected}")

  execute_process(COMMAND ${compile} -DASTROID_ALLOWED ${SOURCE} RESULT_VARIABLE status ERROR_VARIABLE said)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${SOURCE}: the allowed variant does not compile:\n${said}")
  endif()
  execute_process(COMMAND ${compile} ${SOURCE} RESULT_VARIABLE status ERROR_VARIABLE said)
  if(status EQUAL 0)
    message(FATAL_ERROR "${SOURCE}: compiles, and should not")
  endif()
  if(NOT said MATCHES "error: [^\n]*${expected}")
    message(FATAL_ERROR "${SOURCE}: fails for another reason than '${expected}':\n${said}")
  endif()
  return()
endif()

function(astroid_add_compile_fail_test label)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES" ${ARGN})
  foreach(library IN LISTS ARG_LIBRARIES)
    list(APPEND includes "$<TARGET_PROPERTY:${library},INTERFACE_INCLUDE_DIRECTORIES>")
  endforeach()
  foreach(source IN LISTS ARG_SOURCES)
    get_filename_component(name ${source} NAME_WE)
    set(test ${label}.compile_fail.${name})
    add_test(NAME ${test}
      COMMAND ${CMAKE_COMMAND} -DSOURCE=${CMAKE_CURRENT_SOURCE_DIR}/${source} -P ${PROJECT_SOURCE_DIR}/cmake/AstroidCompileFail.cmake
              -- ${CMAKE_CXX_COMPILER} -std=c++20 -fsyntax-only "-I$<JOIN:${includes},;-I>"
      COMMAND_EXPAND_LISTS)
    set_tests_properties(${test} PROPERTIES LABELS ${label} TIMEOUT 60 ENVIRONMENT LC_ALL=C)
  endforeach()
endfunction()
