# engine_shaders(TARGET): makes headers of engine.glsl for it, and links Vulkan.
find_package(Vulkan REQUIRED)
find_program(GLSLANG_VALIDATOR glslangValidator REQUIRED)
set(engine_headers)
foreach(stage vertex:vert fragment:frag compose:comp)
  string(REGEX REPLACE ":.*" "" name ${stage})
  string(REGEX REPLACE ".*:" "" kind ${stage})
  string(TOUPPER ${name} define)
  set(header ${CMAKE_CURRENT_BINARY_DIR}/embed/engine_${name}.h)
  add_custom_command(OUTPUT ${header} DEPENDS ${CMAKE_CURRENT_LIST_DIR}/engine.glsl
    COMMAND ${CMAKE_COMMAND} -E make_directory ${CMAKE_CURRENT_BINARY_DIR}/embed
    COMMAND ${GLSLANG_VALIDATOR} -V --quiet -S ${kind} -D${define} --vn ${name} -o ${header}
            ${CMAKE_CURRENT_LIST_DIR}/engine.glsl)
  list(APPEND engine_headers ${header})
endforeach()

function(engine_shaders target)
  target_sources(${target} PRIVATE ${engine_headers})
  target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/embed)
  target_link_libraries(${target} PRIVATE Vulkan::Vulkan m)
endfunction()
