# Run by CPack once all is put together: no folder of libraries is named in what Debian installs, since
# the loader knows them, and manual pages are packed, without a time.
file(GLOB_RECURSE files ${CPACK_TEMPORARY_DIRECTORY}/*)
foreach(file ${files})
  if(file MATCHES "/bin/|/libexec/")
    file(RPATH_REMOVE FILE ${file})
  elseif(file MATCHES "/man/man1/[^/]*\\.1$")
    execute_process(COMMAND gzip -9n ${file} COMMAND_ERROR_IS_FATAL ANY)
  endif()
endforeach()
