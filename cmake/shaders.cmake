# tyndall_add_shaders(TARGET <target> NAME <set> SHADERS a.comp b.vert path@variant:KEY=VALUE ...)
# Compiles each shader with glslc and spirv-opt (names are preserved) and checks it with spirv-val. Reflects its bindings, and
# embeds module and bindings in <set>_shaders.hpp and <set>_shaders.cpp. The header declares one tyndall::gpu::Shader per shader,
# named like the file without its folder and with underscores instead of dots (march_per_pixel_comp). Other targets that
# include it must link TARGET and depend on TARGET_shaders.
# path@variant:KEY=VALUE,KEY=VALUE compiles the shader with these macros and appends the variant to its name.
# TYNDALL_SHADERS_FROM names another build folder, which is up to date: its files are copied instead.
set(TYNDALL_SHADERS_FROM "" CACHE PATH "Build folder whose embedded shaders are copied instead of compiling them")
find_program(TYNDALL_GLSLC glslc REQUIRED)
find_program(TYNDALL_SPIRV_OPT spirv-opt REQUIRED)
find_program(TYNDALL_SPIRV_VAL spirv-val REQUIRED)

function(tyndall_add_shaders)
  cmake_parse_arguments(arg "" "TARGET;NAME" "SHADERS" ${ARGN})
  set(out_dir ${CMAKE_CURRENT_BINARY_DIR}/shaders)
  file(MAKE_DIRECTORY ${out_dir})
  set(modules)
  foreach(entry ${arg_SHADERS})
    set(defines)
    set(macros -)
    set(variant)
    set(source ${entry})
    if(entry MATCHES "^(.+)@([^:]+):(.+)$")
      set(source ${CMAKE_MATCH_1})
      set(variant _${CMAKE_MATCH_2})
      set(macros ${CMAKE_MATCH_3})
      string(REPLACE "," ";-D" defines "-D${macros}")
    endif()
    get_filename_component(name ${source} NAME)
    string(REPLACE "." "_" name ${name})
    set(spv ${out_dir}/${name}${variant}.spv)
    if(NOT TYNDALL_SHADERS_FROM)
      add_custom_command(
        OUTPUT ${spv}
        COMMAND ${TYNDALL_GLSLC} --target-env=vulkan1.2 -Werror ${defines}
                -I ${PROJECT_SOURCE_DIR}/shaders -I ${PROJECT_SOURCE_DIR}/include -I ${PROJECT_SOURCE_DIR}/src
                -I ${PROJECT_BINARY_DIR}/include
                -MD -MF ${spv}.d -MT ${spv} ${PROJECT_SOURCE_DIR}/shaders/${source} -o ${spv}.raw
        COMMAND ${TYNDALL_SPIRV_OPT} -O ${spv}.raw -o ${spv}
        COMMAND ${TYNDALL_SPIRV_VAL} --target-env vulkan1.2 ${spv}
        DEPENDS ${PROJECT_SOURCE_DIR}/shaders/${source}
        DEPFILE ${spv}.d
        COMMENT "Shader ${source}${variant}"
        VERBATIM)
    endif()
    list(APPEND modules ${spv})
    # One row per shader, for programs that compile shaders at run time: set|name|source|macros.
    set_property(GLOBAL APPEND PROPERTY TYNDALL_SHADER_ROWS "${arg_NAME}|${name}${variant}|${source}|${macros}")
  endforeach()
  set(files ${out_dir}/${arg_NAME}_shaders.hpp ${out_dir}/${arg_NAME}_shaders.cpp)
  if(TYNDALL_SHADERS_FROM)
    file(RELATIVE_PATH folder ${PROJECT_BINARY_DIR} ${out_dir})
    foreach(file ${files})
      get_filename_component(name ${file} NAME)
      set(built ${TYNDALL_SHADERS_FROM}/${folder}/${name})
      add_custom_command(OUTPUT ${file} COMMAND ${CMAKE_COMMAND} -E copy_if_different ${built} ${file} DEPENDS ${built} VERBATIM)
    endforeach()
  else()
    add_custom_command(
      OUTPUT ${files}
      COMMAND tyndall_embed_shaders ${files} ${modules}
      DEPENDS tyndall_embed_shaders ${modules}
      COMMENT "Embedding ${arg_NAME} shaders"
      VERBATIM)
  endif()
  add_custom_target(${arg_TARGET}_shaders DEPENDS ${files})
  add_dependencies(${arg_TARGET} ${arg_TARGET}_shaders)
  target_include_directories(${arg_TARGET} PRIVATE ${out_dir})
  target_sources(${arg_TARGET} PRIVATE ${files})
endfunction()
