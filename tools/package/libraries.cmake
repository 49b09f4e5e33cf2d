# Installs the shared libraries that the program, its codecs, its optical flow and OSMesa need, and
# their licences.
# glibc and GCC's libraries are the machine's own, because its graphics drivers need theirs.
if(NOT osmesa)
  message(FATAL_ERROR "OSMesa is missing (Debian: libosmesa6), and an archive needs it")
endif()
file(GET_RUNTIME_DEPENDENCIES RESOLVED_DEPENDENCIES_VAR libraries
  EXECUTABLES ${program}
  LIBRARIES ${late} ${osmesa}
  PRE_EXCLUDE_REGEXES "^libmujoco"
    "^(ld-linux.*|lib(c|m|mvec|dl|rt|pthread|resolv|util|anl|stdc\\+\\+|gcc_s))\\.so")
set(prefix $ENV{DESTDIR}${CMAKE_INSTALL_PREFIX})
set(folder ${prefix}/${libraries_folder})
file(MAKE_DIRECTORY ${folder})
foreach(library IN LISTS libraries osmesa)
  cmake_path(GET library FILENAME name)
  file(REAL_PATH ${library} real)
  # auditwheel copies a wheel's libraries, but cannot know OSMesa.
  if(NOT is_wheel OR library STREQUAL osmesa)
    file(COPY_FILE ${real} ${folder}/${name})
    # The loader ignores the program's run path for a library that has its own.
    file(RPATH_REMOVE FILE ${folder}/${name})
  endif()
  # Debian lists some files in /lib, which is a link to /usr/lib.
  string(REGEX REPLACE "^/usr/lib/" "/lib/" alias ${real})
  list(APPEND reals ${real} ${alias})
endforeach()

find_program(dpkg_query dpkg-query)
if(dpkg_query)
  execute_process(COMMAND ${dpkg_query} --search ${reals} OUTPUT_VARIABLE owners ERROR_QUIET)
  string(REGEX MATCHALL "[^\n]+: /" owners "${owners}")
  foreach(owner IN LISTS owners)
    string(REGEX REPLACE "[:,].*" "" package ${owner})
    file(REAL_PATH /usr/share/doc/${package}/copyright copyright)
    if(EXISTS ${copyright})
      file(MAKE_DIRECTORY ${prefix}/${licences_folder})
      file(COPY_FILE ${copyright} ${prefix}/${licences_folder}/${package} ONLY_IF_DIFFERENT)
    endif()
  endforeach()
endif()
