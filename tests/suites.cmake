# Writes a CTest file with a test for each test suite of a program: one process, so that what a suite
# sets up once is set up once. Variables: PROGRAM, FILE.
execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE listed COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "[^\n]+" lines "${listed}")
set(text "")
foreach(line IN LISTS lines)
  if(line MATCHES "^([A-Za-z0-9_/]+)\\.")  # the cases that follow are indented
    set(suite ${CMAKE_MATCH_1})
    string(APPEND text "add_test([==[${suite}]==] [==[${PROGRAM}]==] \"--gtest_filter=${suite}.*\")\n")
  endif()
endforeach()
if(NOT text)
  message(FATAL_ERROR "${PROGRAM} lists no tests")
endif()
file(WRITE ${FILE} "${text}")
