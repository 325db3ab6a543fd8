# What `cmake --install` puts in place: the program, the library with its header, and how other projects find it.
include(CMakePackageConfigHelpers)
install(TARGETS farcull_library EXPORT farcull ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(FILES library/farcull.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/farcull)

set(farcull_cmake_dir ${CMAKE_INSTALL_LIBDIR}/cmake/farcull)
install(EXPORT farcull NAMESPACE farcull:: DESTINATION ${farcull_cmake_dir} FILE farcullTargets.cmake)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/farcullConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
# What a program that uses the library links: as NAME:MODULE:DEBIAN-PACKAGE, and for pkg-config.
set(farcull_links hwy:libhwy:libhwy-dev)
set(farcull_requires libhwy)
if(FARCULL_GL)
  string(PREPEND farcull_links "epoxy:epoxy:libepoxy-dev ")
  string(PREPEND farcull_requires "epoxy ")
endif()
configure_file(library/farcullConfig.cmake farcullConfig.cmake @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/farcullConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/farcullConfigVersion.cmake
  DESTINATION ${farcull_cmake_dir})

# The installed tree may be moved: its place is told from that of the file.
file(RELATIVE_PATH farcull_prefix ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
configure_file(library/farcull.pc.in farcull.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/farcull.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

# The program finds it from its own place.
install(DIRECTORY report/ DESTINATION share/farcull/report PATTERN __pycache__ EXCLUDE)
install(TARGETS farcull RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
if(NOT CMAKE_CROSSCOMPILING)
  install(FILES ${farcull_texts}/farcull.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
  install(FILES ${farcull_texts}/farcull DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
  install(FILES ${farcull_texts}/_farcull DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
  install(FILES ${farcull_texts}/farcull.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
endif()
