# Writes the commit of SOURCE into HEADER, unless HEADER has it already.
cmake_policy(VERSION 3.25)
set(commit unknown)
find_program(git git)
if(git)
  # In a container the sources may belong to another user; git rejects that without safe.directory.
  execute_process(COMMAND ${git} -c safe.directory=* -C ${SOURCE}
      describe --always "--dirty=, changed since" --exclude=*
    OUTPUT_VARIABLE described OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE result)
  if(result EQUAL 0)
    set(commit ${described})
  endif()
endif()
file(CONFIGURE OUTPUT ${HEADER} CONTENT "#define LCS_COMMIT \"@commit@\"\n" @ONLY)
