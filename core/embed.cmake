# farcull_embed(TARGET FILE...): makes each text FILE (a shader) a constant of the namespace farcull::embedded,
# named after the file with dots and slashes as underscores, declared in "embedded/NAME.h".
function(farcull_embed target)
  foreach(file IN LISTS ARGN)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${file})
    file(READ ${CMAKE_CURRENT_SOURCE_DIR}/${file} text)
    get_filename_component(name ${file} NAME)
    string(REGEX REPLACE "[^A-Za-z0-9]" "_" name ${name})
    file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/generated/embedded/${name}.h @ONLY CONTENT
"// Made by core/embed.cmake from ${file}; edit that file.
#pragma once
namespace farcull::embedded {
inline constexpr char ${name}[] = R\"glsl(${text})glsl\";
}
")
  endforeach()
  target_include_directories(${target} PUBLIC ${CMAKE_BINARY_DIR}/generated)
endfunction()
