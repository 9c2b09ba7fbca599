# Run by CPack once all is put together: no folder of libraries is named in what Debian installs, since
# the loader knows them, and manual pages are packed, without a time. All files get that of the commit, and
# folders may be read by all whatever the umask, so that two builds give equal packages.
if(NOT DEFINED ENV{SOURCE_DATE_EPOCH})
  execute_process(COMMAND git -C ${CMAKE_CURRENT_LIST_DIR} log -1 --format=%ct OUTPUT_VARIABLE time
                  OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(NOT time)
    set(time 0)
  endif()
  set(ENV{SOURCE_DATE_EPOCH} ${time})
endif()
file(GLOB_RECURSE files LIST_DIRECTORIES true ${CPACK_TEMPORARY_DIRECTORY}/*)
foreach(file ${files})
  if(IS_DIRECTORY ${file})
    file(CHMOD ${file} DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
                                             WORLD_READ WORLD_EXECUTE)
  elseif(file MATCHES "/bin/|/libexec/")
    file(RPATH_REMOVE FILE ${file})
  elseif(file MATCHES "/man/man1/[^/]*\\.1$")
    execute_process(COMMAND gzip -9n ${file} COMMAND_ERROR_IS_FATAL ANY)
  endif()
endforeach()
