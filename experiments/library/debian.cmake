# CPack runs this script before packing. It changes the installed files as Debian's policy requires.
set(usr ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/usr)
set(doc ${usr}/share/doc/${CPACK_PACKAGE_NAME})

# Every Debian system has the texts of the licenses, so the package must not contain them.
file(READ ${doc}/LICENSE text)
string(REGEX REPLACE "The text of the LGPL comes first[.].*" "" text "${text}")
file(WRITE ${doc}/copyright "${text}On Debian, the texts of the licenses are in /usr/share/common-licenses/LGPL-3 and /usr/share/common-licenses/GPL-3.

The files hold compiled code of these Debian packages, too; /usr/share/doc/PACKAGE/copyright has the license of each:
libcgal-dev, libeigen3-dev, libboost-dev, libhwy-dev, libcli11-dev, nlohmann-json3-dev, libfmt-dev, libsqlitecpp-dev,
pybind11-dev, libfcl-dev, libbullet-dev, libjs-three.
")
file(REMOVE ${doc}/LICENSE)

string(TIMESTAMP now "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(WRITE ${doc}/changelog "${CPACK_PACKAGE_NAME} (${CPACK_PACKAGE_VERSION}) unstable; urgency=medium

  * The package that cpack makes of this version.

 -- ${CPACK_PACKAGE_CONTACT}  ${now}
")
execute_process(COMMAND gzip -9n ${doc}/changelog COMMAND_ERROR_IS_FATAL ANY)

# Debian's Python reads only lib/python3/dist-packages, whatever prefix the build was configured for.
file(GLOB python ${usr}/lib/python3.*/*-packages)
if(python)
  file(MAKE_DIRECTORY ${usr}/lib/python3)
  file(RENAME ${python} ${usr}/lib/python3/dist-packages)
  get_filename_component(python ${python} DIRECTORY)
  file(REMOVE_RECURSE ${python})
endif()
file(GLOB_RECURSE archive ${usr}/lib/libfarcull.a)
execute_process(COMMAND strip --strip-debug --enable-deterministic-archives ${archive} COMMAND_ERROR_IS_FATAL ANY)
