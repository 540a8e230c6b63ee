# SPDX-License-Identifier: Apache-2.0
# What the models need of Debian's packages, for the build by emscripten (make playground). All of it is headers; a
# folder holds links to those alone, since the rest of /usr/include belongs to another C library.
set(DTOF_SYSTEM_INCLUDE /usr/include CACHE PATH "Where the headers of the Debian packages are")
set(headers ${CMAKE_BINARY_DIR}/headers)
file(MAKE_DIRECTORY ${headers})
foreach(folder boost concepts fmt meta nlohmann Random123 range std toml++ zconf.h zlib.h)
  if(NOT EXISTS ${DTOF_SYSTEM_INCLUDE}/${folder})
    message(FATAL_ERROR "${DTOF_SYSTEM_INCLUDE}/${folder} is missing: scripts/install_packages.sh playground installs it")
  endif()
  file(CREATE_LINK ${DTOF_SYSTEM_INCLUDE}/${folder} ${headers}/${folder} SYMBOLIC)
endforeach()
include_directories(SYSTEM ${headers})

foreach(package fmt::fmt Boost::headers PkgConfig::tomlplusplus nlohmann_json::nlohmann_json ZLIB::ZLIB)
  add_library(${package} INTERFACE IMPORTED)
endforeach()
target_compile_definitions(fmt::fmt INTERFACE FMT_HEADER_ONLY)

# Exceptions are WebAssembly's own: through JavaScript, every call that may throw would leave the module.
add_compile_options(-fwasm-exceptions)
add_link_options(-fwasm-exceptions)

# dtof_prelude(<library> ...): each file of the libraries begins with what emscripten's C++ library lacks.
function(dtof_prelude first)
  target_precompile_headers(${first} PRIVATE ${PROJECT_SOURCE_DIR}/app/playground/prelude.hpp)
  foreach(library ${ARGN})
    target_precompile_headers(${library} REUSE_FROM ${first})
  endforeach()
endfunction()
