# libroil: one library of the layer `roil` and what it needs of those below, and what is installed.
#
# roil::roil, shared, exports the functions of the public headers and nothing else; so does libroil.a,
# one object whose other symbols are local. As a part of another project's build, only roil::roil is
# meant to be used; it finds shaders and the reader in the folder where it was built.
file(GLOB headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/*.h)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${headers})
set(functions)
foreach(header ${headers})
  file(STRINGS ${header} lines)
  foreach(line ${lines})
    string(REGEX REPLACE "//.*" "" line "${line}")
    string(REGEX MATCHALL "roil_[a-z0-9_]+\\(" found "${line}")
    list(APPEND functions ${found})
  endforeach()
endforeach()
list(REMOVE_DUPLICATES functions)
list(SORT functions)
string(REPLACE "(" "" functions "${functions}")
string(REPLACE ";" "\n" names "${functions}")
string(REPLACE ";" ";\n        " exported "${functions}")
set(generated ${PROJECT_BINARY_DIR}/generated)
file(CONFIGURE OUTPUT ${generated}/functions.txt CONTENT "${names}\n")
file(CONFIGURE OUTPUT ${generated}/roil.map CONTENT "{\n    global:\n        ${exported};\n    local: *;\n};\n")

set(layers script effect pass sim scene field graph kernel media shader gpu base)
list(TRANSFORM layers PREPEND roil_)
# The number in the name grows when programs must be built again; it is none of the version's.
set(abi 1)
add_library(roil SHARED $<TARGET_OBJECTS:roil_roil>)
add_library(roil::roil ALIAS roil)
target_link_libraries(roil PRIVATE ${layers})
target_link_options(roil PRIVATE LINKER:--version-script=${generated}/roil.map LINKER:-z,defs)
target_include_directories(roil INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src>
                                          $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/roil>)
set_target_properties(roil PROPERTIES LINK_DEPENDS ${generated}/roil.map
                      SOVERSION ${abi} VERSION ${abi}.${PROJECT_VERSION})
add_dependencies(roil roil_reader_program)
set(whole TRUE) # what is installed: of no use with sanitizers, which a host would have to have
if(ROIL_SANITIZE OR ROIL_FUZZ OR NOT PROJECT_IS_TOP_LEVEL)
  set(whole FALSE)
endif()
if(ROIL_SANITIZE OR ROIL_FUZZ)
  set_target_properties(roil PROPERTIES EXCLUDE_FROM_ALL TRUE)
endif()
if(NOT PROJECT_IS_TOP_LEVEL) # where the library looks for them
  file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/share)
  file(CREATE_LINK ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR}/share/roil SYMBOLIC)
endif()

set(archive ${PROJECT_BINARY_DIR}/archive/libroil.a)
list(TRANSFORM layers REPLACE "(.+)" "$<TARGET_FILE:\\1>" OUTPUT_VARIABLE archives)
add_custom_command(OUTPUT ${archive} VERBATIM COMMAND_EXPAND_LISTS
  DEPENDS roil_roil ${layers} ${generated}/functions.txt
  COMMAND ${CMAKE_COMMAND} -E make_directory ${PROJECT_BINARY_DIR}/archive
  COMMAND ${CMAKE_COMMAND} -E rm -f ${archive}
  COMMAND ${CMAKE_LINKER} -r -o ${generated}/roil.o "$<TARGET_OBJECTS:roil_roil>" --start-group ${archives} --end-group
  COMMAND ${CMAKE_OBJCOPY} --keep-global-symbols=${generated}/functions.txt ${generated}/roil.o
  COMMAND ${CMAKE_AR} qcD ${archive} ${generated}/roil.o
  COMMAND ${CMAKE_AR} sD ${archive})
if(whole)
  add_custom_target(roil_archive ALL DEPENDS ${archive})
endif()

# ---- the prefix -------------------------------------------------------------------------------
# Components: `program`, `data` (what a library or a program needs beside it), `library`, and
# `development`. scripts/package takes the first two.
set(libexec ${CMAKE_INSTALL_LIBEXECDIR}/roil)
# Libraries that a Vulkan driver may use too are taken from the machine where it has them, since a
# driver may need a newer one than ours: so their folders stand between ours, in a DT_RPATH, which
# unlike DT_RUNPATH holds for the libraries of libraries.
set(system /usr/lib/x86_64-linux-gnu:/lib/x86_64-linux-gnu:/usr/lib64:/lib64:/usr/lib)
function(roil_rpath target up)
  set_target_properties(${target} PROPERTIES INSTALL_RPATH "$ORIGIN/${up}/lib:${system}:$ORIGIN/${up}/lib/fallback")
  target_link_options(${target} PRIVATE LINKER:--disable-new-dtags)
endfunction()

roil_rpath(roil_reader_program ../..)
roil_rpath(roil_reader_vdb ../..)
install(TARGETS roil_reader_program roil_reader_vdb RUNTIME DESTINATION ${libexec} COMPONENT data)
if(TARGET roil_flow)
  install(TARGETS roil_flow LIBRARY DESTINATION ${libexec} COMPONENT data OPTIONAL)
endif()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/shaders ${PROJECT_SOURCE_DIR}/effects
        DESTINATION ${CMAKE_INSTALL_DATADIR}/roil COMPONENT data PATTERN gallery EXCLUDE)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/tests/golden DESTINATION ${CMAKE_INSTALL_DATADIR}/roil/tests COMPONENT data
        FILES_MATCHING PATTERN *.png PATTERN pictures.txt) # of `roil info effects`
install(DIRECTORY ${PROJECT_SOURCE_DIR}/scripts DESTINATION ${CMAKE_INSTALL_DATADIR}/roil COMPONENT data
        FILES_MATCHING PATTERN *.lua PATTERN *.css PATTERN *.html PATTERN *.obj PATTERN *.mtl)

install(TARGETS roil EXPORT roil LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
        COMPONENT library NAMELINK_COMPONENT development)
if(PROJECT_IS_TOP_LEVEL)
  install(FILES ${archive} DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
endif()
install(FILES ${headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/roil COMPONENT development)
set(modules "lua5.4 jansson libpng zlib OpenEXR blosc libturbojpeg libxxhash spirv-cross-c-shared vulkan")
include(CMakePackageConfigHelpers)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/roil)
install(EXPORT roil NAMESPACE roil:: FILE roil-targets.cmake DESTINATION ${package} COMPONENT development)
configure_package_config_file(${PROJECT_SOURCE_DIR}/src/roil/roil-config.cmake.in
                              ${generated}/roil-config.cmake INSTALL_DESTINATION ${package}
                              PATH_VARS CMAKE_INSTALL_LIBDIR CMAKE_INSTALL_INCLUDEDIR)
write_basic_package_version_file(${generated}/roil-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${generated}/roil-config.cmake ${generated}/roil-config-version.cmake DESTINATION ${package}
        COMPONENT development)
file(RELATIVE_PATH up /${CMAKE_INSTALL_LIBDIR}/pkgconfig /) # so that the prefix may lie anywhere
configure_file(${PROJECT_SOURCE_DIR}/src/roil/roil.pc.in ${generated}/roil.pc @ONLY)
install(FILES ${generated}/roil.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)

# Called once the program is there.
function(roil_install_program)
  roil_rpath(roil_program ..)
  install(TARGETS roil_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
  install(PROGRAMS ${PROJECT_SOURCE_DIR}/scripts/farm DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program
    RENAME roil-farm)
  set(files)
  foreach(format man:man/man1/roil.1 bash:bash-completion/completions/roil zsh:zsh/site-functions/_roil)
    string(REGEX REPLACE ":.*" "" word ${format})
    string(REGEX REPLACE ".*:" "" path ${format})
    get_filename_component(folder ${path} DIRECTORY)
    set(file ${PROJECT_BINARY_DIR}/generated/${path})
    file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/generated/${folder})
    add_custom_command(OUTPUT ${file} DEPENDS roil_program
                       COMMAND roil_program --describe ${word} > ${file})
    install(FILES ${file} DESTINATION ${CMAKE_INSTALL_DATADIR}/${folder} COMPONENT program)
    list(APPEND files ${file})
  endforeach()
  if(whole)
    set(all ALL)
  endif()
  add_custom_target(roil_described ${all} DEPENDS ${files})
endfunction()

# ---- Debian packages: `cpack -G DEB` in the build folder --------------------------------------
if(PROJECT_IS_TOP_LEVEL)
  # What is linked in, of which Debian has the headers or an archive: its licences go along.
  set(linked glslang-dev spirv-tools libimgui-dev libcglm-dev libboost1.74-dev)
  file(READ ${PROJECT_SOURCE_DIR}/LICENSE copyright)
  string(APPEND copyright "\nThe effects, and all that they read, are under this licence too.\n")
  foreach(name ${linked})
    if(EXISTS /usr/share/doc/${name}/copyright)
      file(READ /usr/share/doc/${name}/copyright text)
      string(APPEND copyright "\n==== linked in from Debian's package ${name}\n\n${text}")
    endif()
  endforeach()
  file(CONFIGURE OUTPUT ${generated}/copyright CONTENT "@copyright@" @ONLY)
  foreach(package roil:program libroil${abi}:library libroil-dev:development)
    string(REGEX REPLACE ":.*" "" name ${package})
    string(REGEX REPLACE ".*:" "" component ${package})
    install(FILES ${generated}/copyright DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/${name}
            COMPONENT ${component} EXCLUDE_FROM_ALL)
  endforeach()

  set(CPACK_GENERATOR DEB)
  set(CPACK_PACKAGE_NAME roil)
  set(CPACK_PACKAGE_VENDOR roil)
  set(CPACK_PACKAGE_CONTACT "the roil authors <roil@localhost>")
  set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "fire and smoke from Lua files, drawn with Vulkan")
  set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
  set(CPACK_STRIP_FILES ON)
  set(CPACK_DEB_COMPONENT_INSTALL ON)
  set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
  set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
  set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
  set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/src/roil/debian.cmake)
  set(CPACK_POST_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/src/roil/debian_again.cmake)
  set(CPACK_ROIL_AR ${CMAKE_AR})
  set(exactly "(= ${PROJECT_VERSION})")
  set(CPACK_DEBIAN_ROIL_PACKAGE_NAME roil)
  set(CPACK_DEBIAN_ROIL_PACKAGE_DEPENDS "libroil${abi} ${exactly}")
  set(CPACK_DEBIAN_ROIL_PACKAGE_RECOMMENDS "mesa-vulkan-drivers | vulkan-icd, fonts-inter | fonts-dejavu-core")
  set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libroil${abi})
  set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
  # Opened by name when the first film is begun (src/media/av.h).
  set(CPACK_DEBIAN_LIBRARY_PACKAGE_SUGGESTS "libavformat59, libavcodec59, libswscale6, libavutil57")
  set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libroil-dev)
  set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
  string(CONCAT depends "libroil${abi} ${exactly}, liblua5.4-dev, libjansson-dev, libpng-dev, zlib1g-dev, "
                        "libopenexr-dev, libblosc-dev, libturbojpeg0-dev, libxxhash-dev, libspirv-cross-c-shared-dev, libvulkan-dev")
  set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS ${depends})
  include(CPack)
  cpack_add_component(program GROUP roil)
  cpack_add_component(library GROUP library)
  cpack_add_component(data GROUP library)
  cpack_add_component(development GROUP development)
  cpack_add_component_group(roil DESCRIPTION "the program: renders effects, and shows them in a window")
  cpack_add_component_group(library DESCRIPTION "the library, its shaders, and the process that reads files")
  cpack_add_component_group(development DESCRIPTION "headers, archive, and packages for CMake and pkg-config")
endif()
