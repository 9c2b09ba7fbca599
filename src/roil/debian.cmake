# Run by CPack once all is put together: no folder of libraries is named in what Debian installs, since
# the loader knows them, and manual pages are packed, without a time. All files get that of the commit, so
# that two builds give equal packages.
if(NOT DEFINED ENV{SOURCE_DATE_EPOCH})
  execute_process(COMMAND git -C ${CMAKE_CURRENT_LIST_DIR} log -1 --format=%ct OUTPUT_VARIABLE time
                  OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(NOT time)
    set(time 0)
  endif()
  set(ENV{SOURCE_DATE_EPOCH} ${time})
endif()
file(GLOB_RECURSE files ${CPACK_TEMPORARY_DIRECTORY}/*)
foreach(file ${files})
  if(file MATCHES "/bin/|/libexec/")
    file(RPATH_REMOVE FILE ${file})
  elseif(file MATCHES "/man/man1/[^/]*\\.1$")
    execute_process(COMMAND gzip -9n ${file} COMMAND_ERROR_IS_FATAL ANY)
  endif()
endforeach()
