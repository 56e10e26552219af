# Compiles every shader of a folder to SPIR-V, validates it and embeds it: the program carries its shaders.
# A shader's name is its file name without its folder: ldc/ldc_raster.comp -> "ldc_raster", view/visibility.vert -> "visibility.vert".
find_program(GLSLC glslc REQUIRED)
find_program(SPIRV_OPT spirv-opt REQUIRED)
find_program(SPIRV_VAL spirv-val REQUIRED)
option(PEELRAY_OPTIMIZE_SHADERS "OFF: shaders are made in a third of the time, and not meant to run" ON)

# peelray_embed_shaders(TARGET DIR): a static library TARGET with every .comp, .vert, .tesc, .tese, .geom, .frag, .rgen, .rmiss,
# .rchit and .rahit of DIR and the folders in it.
function(peelray_embed_shaders target dir)
  set(patterns)
  foreach(kind comp vert tesc tese geom frag rgen rmiss rchit rahit)
    list(APPEND patterns ${dir}/*.${kind})
  endforeach()
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${patterns})
  set(objects)
  foreach(source ${sources})
    get_filename_component(file ${source} NAME)
    set(output ${CMAKE_CURRENT_BINARY_DIR}/${target}/${file}.spv)
    set(optimize)
    if(PEELRAY_OPTIMIZE_SHADERS)
      set(optimize -O)
    endif()
    add_custom_command(
      OUTPUT ${output}
      COMMAND ${CMAKE_COMMAND} -E make_directory ${CMAKE_CURRENT_BINARY_DIR}/${target}
      # glslc -O would drop the names that reflection finds the bindings by; spirv-opt keeps them.
      COMMAND ${GLSLC} --target-env=vulkan1.3 -O0 -Werror -I ${PROJECT_SOURCE_DIR}/shaders -I ${PROJECT_SOURCE_DIR}/include
              -MD -MF ${output}.d -o ${output} ${source}
      COMMAND ${SPIRV_OPT} --target-env=vulkan1.3 --scalar-block-layout ${optimize} ${output} -o ${output}
      COMMAND ${SPIRV_VAL} --target-env vulkan1.3 --scalar-block-layout ${output}
      DEPENDS ${source} DEPFILE ${output}.d
      COMMENT "Shader ${file}" VERBATIM)
    list(APPEND objects ${output})
  endforeach()
  set(table ${CMAKE_CURRENT_BINARY_DIR}/${target}.cpp)
  add_custom_command(
    OUTPUT ${table}
    COMMAND ${CMAKE_COMMAND} -DOUTPUT=${table} -DTABLE=${target} "-DSHADERS=${objects}"
            -P ${PROJECT_SOURCE_DIR}/cmake/embed.cmake
    DEPENDS ${objects} ${PROJECT_SOURCE_DIR}/cmake/embed.cmake COMMENT "Embed ${target}" VERBATIM)
  add_library(${target} STATIC ${table})
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/src)
endfunction()
