# Run by CPack once the packages are there: it has written the umask into them, as permissions of their
# three parts, so they are put together once more, as two builds would do it alike.
foreach(package ${CPACK_PACKAGE_FILES})
  set(folder ${package}.parts)
  file(MAKE_DIRECTORY ${folder})
  execute_process(COMMAND ${CPACK_ROIL_AR} x ${package} WORKING_DIRECTORY ${folder} COMMAND_ERROR_IS_FATAL ANY)
  file(GLOB control RELATIVE ${folder} ${folder}/control.*)
  file(GLOB data RELATIVE ${folder} ${folder}/data.*)
  file(REMOVE ${package})
  execute_process(COMMAND ${CPACK_ROIL_AR} qcSD ${package} debian-binary ${control} ${data}
                  WORKING_DIRECTORY ${folder} COMMAND_ERROR_IS_FATAL ANY)
  file(REMOVE_RECURSE ${folder})
endforeach()
